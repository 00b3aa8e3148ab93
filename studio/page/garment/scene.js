// Canvas, camera and light. A picture is drawn when something changed, not all the time, so that a page at rest costs
// nothing.

import {
    AmbientLight,
    Color,
    DirectionalLight,
    Group,
    PerspectiveCamera,
    Plane,
    Scene,
    Vector3,
    WebGLRenderer,
} from "../vendor/three.module.min.js";
import { oncePerFrame } from "../dom/element.js";
import { colour } from "../head/theme.js";
import { watch } from "../server/store.js";

/** More pixels than this to one of the page are not seen, but cost. */
const MOST_PIXELS = 2;

/** Throws where the browser has no WebGL. */
export function makeScene(canvas) {
    const renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: "low-power" });
    renderer.setPixelRatio(Math.min(devicePixelRatio, MOST_PIXELS));
    const scene = new Scene();
    const camera = new PerspectiveCamera(28, 1, 0.01, 50);
    const key = new DirectionalLight(0xffffff, 2.2);
    key.position.set(-0.6, 0.8, 1);
    camera.add(key);
    scene.add(camera, new AmbientLight(0xffffff, 1.1));
    const world = new Group();
    scene.add(world);
    const section = new Plane(new Vector3(0, 0, -1), 0);
    let pictures = 0;

    const draw = oncePerFrame(() => {
        renderer.render(scene, camera);
        pictures += 1;
        canvas.dataset.pictures = pictures;
    });
    new ResizeObserver(() => {
        const { width, height } = canvas.parentElement.getBoundingClientRect();
        if (!width || !height) return;
        renderer.setSize(width, height, false);
        camera.aspect = width / height;
        camera.updateProjectionMatrix();
        draw();
    }).observe(canvas.parentElement);
    const ground = () => {
        scene.background = new Color(colour("ground"));
        draw();
    };
    watch(["theme"], ground);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", ground);

    return {
        renderer,
        scene,
        camera,
        world,
        draw,
        section,
        /** Shows what lies on one side of a plane; nothing without one. */
        cut(normal, at) {
            renderer.clippingPlanes = normal ? [section.set(new Vector3(...normal), at)] : [];
            draw();
        },
    };
}

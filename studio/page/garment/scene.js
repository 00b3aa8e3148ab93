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
import { afterPause, oncePerFrame } from "../dom/element.js";
import { colour } from "../head/theme.js";
import { watch } from "../server/store.js";

/** More pixels than this to one of the page are not seen, but cost. */
const MOST_PIXELS = 2;

/** How long after its last change a picture is drawn anew in more pixels, where no graphics card draws, ms. */
const REST = 200;

/** Whether the processor draws, not a graphics card. */
function isSoftware() {
    const gl = document.createElement("canvas").getContext("webgl2");
    if (!gl) return false;
    const named = gl.getExtension("WEBGL_debug_renderer_info");
    const name = gl.getParameter(named ? named.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
    gl.getExtension("WEBGL_lose_context")?.loseContext();
    return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

/** Throws where the browser has no WebGL. */
export function makeScene(canvas) {
    // Smooth edges take a processor more than half of its time: it draws them only once the picture rests.
    const isSlow = isSoftware();
    const renderer = new WebGLRenderer({ canvas, antialias: !isSlow, powerPreference: "low-power" });
    const quick = Math.min(devicePixelRatio, isSlow ? 1 : MOST_PIXELS);
    renderer.setPixelRatio(quick);
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

    const render = (pixels) => {
        if (renderer.getPixelRatio() !== pixels) renderer.setPixelRatio(pixels);
        renderer.render(scene, camera);
        pictures += 1;
        canvas.dataset.pictures = pictures;
    };
    const atRest = afterPause(REST, () => render(MOST_PIXELS));
    const draw = oncePerFrame(() => {
        render(quick);
        if (isSlow) atRest();
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

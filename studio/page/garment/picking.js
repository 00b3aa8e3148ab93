// The triangle below a place of the screen.

import { Raycaster, Triangle, Vector2, Vector3 } from "../vendor/three.module.min.js";

export function picker(canvas, camera, object) {
    const ray = new Raycaster();
    const corners = [new Vector3(), new Vector3(), new Vector3()];
    const shares = new Vector3();

    /** `{triangle, shares}`, nothing beside the garment. */
    return (clientX, clientY) => {
        if (!object.visible) return null;
        const { x, y, width, height } = canvas.getBoundingClientRect();
        ray.setFromCamera(
            new Vector2((2 * (clientX - x)) / width - 1, 1 - (2 * (clientY - y)) / height),
            camera,
        );
        const hit = ray.intersectObject(object, false)[0];
        if (!hit) return null;
        const places = object.geometry.attributes.position;
        [hit.face.a, hit.face.b, hit.face.c].forEach((vertex, i) =>
            corners[i].fromBufferAttribute(places, vertex),
        );
        Triangle.getBarycoord(hit.point, ...corners, shares);
        return { triangle: hit.faceIndex, shares: shares.toArray() };
    };
}

// The garment as a mesh: its places, its looks (texture, colours of the panels, map of strain or pressure), and the
// move from the garment before to the one that came.

import {
    BufferAttribute,
    BufferGeometry,
    DoubleSide,
    Mesh,
    MeshLambertMaterial,
    RepeatWrapping,
    SRGBColorSpace,
    TextureLoader,
} from "../vendor/three.module.min.js";
import { isMap, mapColour, scaleOf } from "./maps.js";

/** How long a garment takes to move to its new place, in milliseconds. */
const MOVE = 350;

const still = matchMedia("(prefers-reduced-motion: reduce)");
const loader = new TextureLoader();

function colours(mesh, looks) {
    const found = new Float32Array(3 * mesh.vertices).fill(0.7);
    if (isMap(looks)) {
        const values = perVertex(mesh, mesh[looks]);
        const scale = scaleOf(values);
        values.forEach((value, i) =>
            found.set(
                mapColour(value / scale).map((c) => c ** 2.2),
                3 * i,
            ),
        );
        return { found, scale };
    }
    for (const { first_vertex: first, vertices, colour } of mesh.panels) {
        const linear = colour.map((c) => (c > 1 ? c / 255 : c) ** 2.2);
        for (let i = first; i < first + vertices; i++) found.set(linear, 3 * i);
    }
    return { found, scale: null };
}

/** Figures of triangles as means at their corners; those of vertices as they are. */
function perVertex(mesh, values) {
    if (values.length === mesh.vertices) return values;
    const sum = new Float32Array(mesh.vertices);
    const count = new Float32Array(mesh.vertices);
    mesh.triangles.forEach((vertex, i) => {
        sum[vertex] += values[Math.floor(i / 3)];
        count[vertex] += 1;
    });
    return sum.map((value, i) => value / Math.max(1, count[i]));
}

export function makeCloth(world, draw) {
    const geometry = new BufferGeometry();
    const object = new Mesh(geometry, []);
    object.visible = false;
    world.add(object);
    let mesh = null;
    let looks = "texture";
    let version = 0;
    let moving = 0;
    const pictures = new Map();

    /** A picture is kept until the next one is there, so that the garment does not go dark between them. */
    function textured() {
        return mesh.panels.map(({ texture: n, colour }) => {
            if (n === null || n === undefined) return plain(colour);
            if (!pictures.has(n)) pictures.set(n, new MeshLambertMaterial({ side: DoubleSide }));
            const material = pictures.get(n);
            if (material.userData.version === version) return material;
            material.userData.version = version;
            loader.load(`/api/texture/${n}?v=${version}`, (texture) => {
                texture.colorSpace = SRGBColorSpace;
                texture.flipY = false;
                // Woven cloth repeats.
                texture.wrapS = texture.wrapT = RepeatWrapping;
                texture.anisotropy = 4;
                material.map?.dispose();
                material.map = texture;
                material.needsUpdate = true;
                draw();
            });
            return material;
        });
    }

    const plain = (rgb) => {
        const [r, g, b] = rgb.map((c) => (c > 1 ? c / 255 : c));
        const material = new MeshLambertMaterial({ side: DoubleSide });
        material.color.setRGB(r, g, b, SRGBColorSpace);
        return material;
    };

    /** Shows the garment by its texture, its panels' colours, or a map; gives the map's scale. */
    function show(next) {
        looks = next;
        if (!mesh) return null;
        for (const material of object.material) if (!material.map) material.dispose();
        let scale = null;
        if (looks === "texture" && mesh.uv) object.material = textured();
        else {
            const made = colours(mesh, mesh[looks] || looks === "panels" ? looks : "panels");
            scale = made.scale;
            geometry.setAttribute("color", new BufferAttribute(made.found, 3));
            const material = new MeshLambertMaterial({ vertexColors: true, side: DoubleSide });
            object.material = mesh.panels.map(() => material);
        }
        draw();
        return scale;
    }

    /** Moves to new places where the mesh has as many vertices as before, else takes them at once. */
    function place(before, to) {
        cancelAnimationFrame(moving);
        if (!before || before.length !== to.length || still.matches) {
            geometry.setAttribute("position", new BufferAttribute(to.slice(), 3));
            geometry.computeVertexNormals();
            geometry.computeBoundingSphere();
            return draw();
        }
        const array = before.slice();
        geometry.setAttribute("position", new BufferAttribute(array, 3));
        const began = performance.now();
        const next = (now) => {
            const share = Math.min(1, (now - began) / MOVE);
            const eased = share * (2 - share);
            for (let i = 0; i < array.length; i++) array[i] = before[i] + eased * (to[i] - before[i]);
            geometry.attributes.position.needsUpdate = true;
            geometry.computeVertexNormals();
            draw();
            if (share < 1) moving = requestAnimationFrame(next);
            else geometry.computeBoundingSphere();
        };
        moving = requestAnimationFrame(next);
        return undefined;
    }

    return {
        object,
        show,
        /** Takes a garment; nothing takes it away. Gives the map's scale. */
        take(next, v) {
            const before = mesh && (geometry.attributes.position?.array ?? mesh.positions);
            mesh = next;
            version = v;
            object.visible = Boolean(mesh);
            if (!mesh) return draw();
            geometry.setIndex(new BufferAttribute(mesh.triangles, 1));
            if (mesh.uv) geometry.setAttribute("uv", new BufferAttribute(mesh.uv, 2));
            geometry.clearGroups();
            mesh.panels.forEach((panel, i) =>
                geometry.addGroup(3 * panel.first_triangle, 3 * panel.triangles, i),
            );
            place(before, mesh.positions);
            return show(looks);
        },
        /** Shows a panel moved by so much. */
        shift(panel, by) {
            const array = geometry.attributes.position?.array;
            if (!mesh || !panel || !array) return;
            cancelAnimationFrame(moving);
            const first = 3 * panel.first_vertex;
            for (let i = 0; i < 3 * panel.vertices; i++)
                array[first + i] = mesh.positions[first + i] + by[i % 3];
            geometry.attributes.position.needsUpdate = true;
            draw();
        },
        /** Goes on to where the garment has come to while it is draped. */
        moveTo(positions) {
            if (mesh && geometry.attributes.position) place(geometry.attributes.position.array, positions);
        },
    };
}

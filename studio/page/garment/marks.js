// What is laid over the garment: the body, the garment before the last edit, open seams and crossings, the panel, the
// edges and the spot that are lit.

import {
    BufferAttribute,
    BufferGeometry,
    DoubleSide,
    LineBasicMaterial,
    LineSegments,
    Mesh,
    MeshBasicMaterial,
    MeshLambertMaterial,
    Points,
    PointsMaterial,
    SphereGeometry,
} from "../vendor/three.module.min.js";
import { store } from "../server/store.js";
import { edgeLine } from "./edge_line.js";

const OPEN = 0xe11d48;
const LIT = 0xf59e0b;
const BEFORE = 0x2563eb;
/** So many threads of seams at most are shown between pieces that are placed. */
const THREADS = 90;

/** Nearer to the eye by a little, so that it is not lost in the cloth below it. */
const above = { polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 };

function geometryOf(positions, triangles) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(positions, 3));
    if (triangles) geometry.setIndex(new BufferAttribute(triangles, 1));
    return geometry;
}

export function makeMarks(world, draw) {
    const part = (object) => {
        object.visible = false;
        object.frustumCulled = false;
        world.add(object);
        return object;
    };
    const body = part(
        new Mesh(new BufferGeometry(), new MeshLambertMaterial({ color: 0xc9b8a8, side: DoubleSide })),
    );
    const before = part(
        new Mesh(
            new BufferGeometry(),
            new MeshBasicMaterial({
                color: BEFORE,
                transparent: true,
                opacity: 0.28,
                depthWrite: false,
                side: DoubleSide,
            }),
        ),
    );
    const panel = part(
        new Mesh(
            new BufferGeometry(),
            new MeshBasicMaterial({
                color: LIT,
                transparent: true,
                opacity: 0.35,
                side: DoubleSide,
                ...above,
            }),
        ),
    );
    const crossings = part(
        new Mesh(new BufferGeometry(), new MeshBasicMaterial({ color: OPEN, side: DoubleSide, ...above })),
    );
    const open = part(
        new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: OPEN, depthTest: false })),
    );
    const edges = part(
        new Points(
            new BufferGeometry(),
            new PointsMaterial({ color: LIT, size: 6, sizeAttenuation: false, depthTest: false }),
        ),
    );
    const spot = part(
        new Mesh(new SphereGeometry(0.008, 16, 12), new MeshBasicMaterial({ color: LIT, depthTest: false })),
    );
    for (const object of [open, edges, spot]) object.renderOrder = 2;

    const put = (object, geometry, visible) => {
        object.geometry.dispose();
        object.geometry = geometry || new BufferGeometry();
        object.visible = Boolean(geometry) && visible;
        draw();
    };
    return {
        body(mesh, on) {
            const geometry = mesh && geometryOf(mesh.positions, mesh.triangles);
            geometry?.computeVertexNormals();
            put(body, geometry, on);
        },
        before: (mesh, on) => put(before, mesh && geometryOf(mesh.positions, mesh.triangles), on),
        faults(mesh, on) {
            // Between pieces that are not sewn yet, threads that are far from each other show which edges belong together.
            const pairs = mesh?.open_seams ?? [];
            const every = store.placing ? Math.ceil(pairs.length / THREADS) : 1;
            const ends = pairs.filter((_, i) => i % every === 0).flat();
            const places = ends.flatMap((i) => [...mesh.positions.subarray(3 * i, 3 * i + 3)]);
            put(open, ends.length > 0 && geometryOf(Float32Array.from(places)), on);
            const corners = (mesh?.crossings ?? []).flatMap((i) => [
                ...mesh.triangles.subarray(3 * i, 3 * i + 3),
            ]);
            put(crossings, corners.length > 0 && geometryOf(mesh.positions, Uint32Array.from(corners)), on);
        },
        /** The panel of that name, the edges and the spot that are lit. */
        light(mesh, name, lines, at) {
            const found = mesh?.panels.find((p) => p.name === name);
            const own =
                found &&
                mesh.triangles.subarray(
                    3 * found.first_triangle,
                    3 * (found.first_triangle + found.triangles),
                );
            put(panel, found && geometryOf(mesh.positions, own), true);
            const places = lines.flatMap(({ piece, edge }) => edgeLine(piece, edge, "positions", 3)).flat();
            put(edges, places.length > 0 && geometryOf(Float32Array.from(places)), true);
            spot.visible = Boolean(mesh && at);
            if (spot.visible) spot.position.set(...at);
            draw();
        },
    };
}

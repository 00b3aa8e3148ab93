// The form in which the program sends meshes: a head in JSON, then arrays of little-endian numbers.

const MAGIC = "TOILEG1\0";
const KINDS = { f32: Float32Array, u32: Uint32Array };

/** `{...head, positions, triangles, flat, photo_px, uv, strain, pressure, distance}`; throws where the bytes are no such file. */
export function readMesh(bytes) {
    const magic = new TextDecoder().decode(new Uint8Array(bytes, 0, MAGIC.length));
    if (magic !== MAGIC) throw new Error("the garment's file does not begin as one");
    const length = new DataView(bytes).getUint32(MAGIC.length, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, MAGIC.length + 4, length)));
    const mesh = { ...head };
    for (const [name, { offset, count, type }] of Object.entries(head.arrays)) {
        const Kind = KINDS[type];
        // `count` may be that of elements or of numbers: the next array or the end says which.
        mesh[name] = new Kind(
            bytes.slice(offset, offset + lengthOf(name, count, head) * Kind.BYTES_PER_ELEMENT),
        );
    }
    return mesh;
}

const WIDTH = { positions: 3, triangles: 3, flat: 2, photo_px: 2, uv: 2, strain: 1, pressure: 1, distance: 1 };

function lengthOf(name, count, head) {
    const width = WIDTH[name] ?? 1;
    const elements = name === "triangles" ? head.triangles : head.vertices;
    return count === elements ? count * width : count;
}

/** The panel of a triangle. */
export const panelOf = (mesh, triangle) =>
    mesh.panels?.find(
        (panel) => triangle >= panel.first_triangle && triangle < panel.first_triangle + panel.triangles,
    );

/** The triangle of a panel that holds a point of a plane (`flat` or `photo_px`), and its share of each corner. */
export function triangleAt(mesh, panel, plane, [x, y]) {
    const points = mesh[plane];
    if (!points) return null;
    for (let i = panel.first_triangle; i < panel.first_triangle + panel.triangles; i++) {
        const [a, b, c] = mesh.triangles.subarray(3 * i, 3 * i + 3);
        const [ax, ay, bx, by] = [points[2 * a], points[2 * a + 1], points[2 * b], points[2 * b + 1]];
        const [cx, cy] = [points[2 * c], points[2 * c + 1]];
        const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
        const u = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area;
        const v = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area;
        // NaN, outside of the photo, is never inside.
        if (u >= 0 && v >= 0 && u + v <= 1) return { triangle: i, shares: [1 - u - v, u, v] };
    }
    return null;
}

/** The spot of a triangle in all planes; nothing of a plane that the garment does not have there. */
export function spotOf(mesh, triangle, shares) {
    const corners = mesh.triangles.subarray(3 * triangle, 3 * triangle + 3);
    const mean = (array, width) => {
        if (!array) return null;
        const at = Array.from({ length: width }, (_, k) =>
            corners.reduce((sum, corner, i) => sum + shares[i] * array[width * corner + k], 0),
        );
        return at.every(Number.isFinite) ? at : null;
    };
    const perTriangle =
        mesh.strain?.length === mesh.triangles.length / 3 && mesh.strain.length !== mesh.vertices;
    return {
        triangle,
        photo: mean(mesh.photo_px, 2),
        flat: mean(mesh.flat, 2),
        position: mean(mesh.positions, 3),
        strain: perTriangle ? mesh.strain[triangle] : (mean(mesh.strain, 1)?.[0] ?? null),
        pressure: mean(mesh.pressure, 1)?.[0] ?? null,
        distance: mean(mesh.distance, 1)?.[0] ?? null,
    };
}

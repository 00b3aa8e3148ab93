// Where the pieces lie in the drawing: in rows, beside each other, in millimetres, y down as drawings have it.

/** The least space between pieces, in millimetres; more where they are many, so that seams are told apart. */
const GAP = 45;
/** That space as a share of the side of a square as large as all pieces. */
const APART = 0.05;

/** Space around all pieces, as a share of the longer side. */
const RIM = 0.05;

const bounds = (points) => {
    const [xs, ys] = [points.map((p) => p[0]), points.map((p) => p[1])];
    return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
};

/**
 * Places pieces (points in metres, y up) for a pane of that form, its width to its height. Gives `{box, at}`: the box
 * that holds all, and for each piece the functions between its own coordinates and the drawing's, and its size.
 */
export function arrange(all, form = 1.5) {
    // The front first, the back last, as people look at them.
    const rank = ({ name }) => (name.startsWith("front") ? 0 : name.startsWith("back") ? 2 : 1);
    const pieces = [...all].sort((a, b) => rank(a) - rank(b));
    const sizes = pieces.map(({ points }) => {
        const [x0, y0, x1, y1] = bounds(points).map((x) => 1000 * x);
        return { x0, y1, width: x1 - x0, height: y1 - y0 };
    });
    const area = sizes.reduce((sum, { width, height }) => sum + width * height, 0);
    const gap = Math.max(GAP, APART * Math.sqrt(area));
    // Rows end where a piece ends: of all such widths the one that shows the pieces largest.
    const widths = sizes.map((_, i) =>
        sizes.slice(0, i + 1).reduce((sum, { width }) => sum + width + gap, 0),
    );
    const widest = Math.max(...sizes.map(({ width }) => width));
    const rows = widths.map((width) => inRows(pieces, sizes, Math.max(width, widest), gap));
    const largeness = ({ box }) => Math.min(form / box[2], 1 / box[3]);
    return rows.reduce((best, next) => (largeness(next) > largeness(best) ? next : best));
}

function inRows(pieces, sizes, row, gap) {
    const at = new Map();
    let [x, y, deep, wide] = [0, 0, 0, 0];
    pieces.forEach((piece, i) => {
        const { x0, y1, width, height } = sizes[i];
        if (x > 0 && x + width > row) [x, y, deep] = [0, y + deep + gap, 0];
        const [left, top] = [x, y];
        at.set(piece.name, {
            to: ([px, py]) => [left + 1000 * px - x0, top + y1 - 1000 * py],
            from: ([X, Y]) => [(X - left + x0) / 1000, (y1 - (Y - top)) / 1000],
            middle: [left + width / 2, top + height / 2],
            size: [width, height],
        });
        x += width + gap;
        deep = Math.max(deep, height);
        wide = Math.max(wide, x - gap);
    });
    // Names and handles stand out beyond the pieces.
    const rim = Math.max(gap / 2, RIM * Math.max(wide, y + deep));
    return { box: [-rim, -rim, wide + 2 * rim, y + deep + 2 * rim], at };
}

// Where the pieces lie in the drawing: in rows, beside each other, in millimetres, y down as drawings have it.

/** Space between pieces, in millimetres. */
const GAP = 45;

/** Space around all pieces, as a share of the longer side. */
const RIM = 0.05;

/** The form of the pane that the pieces are arranged for: its width to its height. */
const ASPECT = 1.5;

const bounds = (points) => {
    const [xs, ys] = [points.map((p) => p[0]), points.map((p) => p[1])];
    return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
};

/**
 * Places pieces (points in metres, y up). Gives `{box, at}`: the box that holds all, and for each piece the functions
 * between its own coordinates and the drawing's.
 */
export function arrange(all) {
    // The front first, the back last, as people look at them.
    const rank = ({ name }) => (name.startsWith("front") ? 0 : name.startsWith("back") ? 2 : 1);
    const pieces = [...all].sort((a, b) => rank(a) - rank(b));
    const sizes = pieces.map(({ points }) => {
        const [x0, y0, x1, y1] = bounds(points).map((x) => 1000 * x);
        return { x0, y1, width: x1 - x0, height: y1 - y0 };
    });
    // Rows end where a piece ends: of all such widths the one that shows the pieces largest.
    const widths = sizes.map((_, i) =>
        sizes.slice(0, i + 1).reduce((sum, { width }) => sum + width + GAP, 0),
    );
    const widest = Math.max(...sizes.map(({ width }) => width));
    const rows = widths.map((width) => inRows(pieces, sizes, Math.max(width, widest)));
    return rows.reduce((best, next) => (largeness(next) > largeness(best) ? next : best));
}

const largeness = ({ box }) => Math.min(ASPECT / box[2], 1 / box[3]);

function inRows(pieces, sizes, row) {
    const at = new Map();
    let [x, y, deep, wide] = [0, 0, 0, 0];
    pieces.forEach((piece, i) => {
        const { x0, y1, width, height } = sizes[i];
        if (x > 0 && x + width > row) [x, y, deep] = [0, y + deep + GAP, 0];
        const [left, top] = [x, y];
        at.set(piece.name, {
            to: ([px, py]) => [left + 1000 * px - x0, top + y1 - 1000 * py],
            from: ([X, Y]) => [(X - left + x0) / 1000, (y1 - (Y - top)) / 1000],
            middle: [left + width / 2, top + height / 2],
        });
        x += width + GAP;
        deep = Math.max(deep, height);
        wide = Math.max(wide, x - GAP);
    });
    // Names and handles stand out beyond the pieces.
    const rim = Math.max(GAP / 2, RIM * Math.max(wide, y + deep));
    return { box: [-rim, -rim, wide + 2 * rim, y + deep + 2 * rim], at };
}

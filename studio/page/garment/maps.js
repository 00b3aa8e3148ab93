// Colours of a map of figures: from dark blue over green to yellow (viridis), which are told apart by those who do not
// see all colours, and in grey.

/** Viridis at nine places (van der Walt and Smith 2015). */
const VIRIDIS = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];
/** Maps with how their figures are written: a share, pascals, metres. */
const FIGURES = {
    strain: (value) => `${(100 * value).toFixed(1)} %`,
    pressure: (value) => `${value.toFixed(value < 10 ? 1 : 0)} Pa`,
    distance: (value) => `${(1000 * value).toFixed(value < 0.01 ? 1 : 0)} mm`,
};
export const isMap = (looks) => looks in FIGURES;
export const figureOf = (looks, value) => FIGURES[looks](value);

const ROUND = [0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1];

export function mapColour(share) {
    const at = Math.min(1, Math.max(0, Number.isFinite(share) ? share : 0)) * (VIRIDIS.length - 1);
    const i = Math.min(VIRIDIS.length - 2, Math.floor(at));
    return VIRIDIS[i].map((c, k) => (c + (at - i) * (VIRIDIS[i + 1][k] - c)) / 255);
}

/** The end of the scale: a round figure above all but one in fifty. */
export function scaleOf(values) {
    const sorted = Float32Array.from(values.filter(Number.isFinite)).sort();
    const high = sorted[Math.floor(0.98 * (sorted.length - 1))] ?? 0;
    const unit = 10 ** Math.max(0, Math.ceil(Math.log10(Math.max(high, 1e-9))));
    return (ROUND.find((round) => round * unit >= high) ?? 1) * unit;
}

/** The legend's stripe, as a canvas. */
export function drawStripe(canvas) {
    const drawing = canvas.getContext("2d");
    for (let x = 0; x < canvas.width; x++) {
        const [r, g, b] = mapColour(x / (canvas.width - 1)).map((c) => Math.round(255 * c));
        drawing.fillStyle = `rgb(${r} ${g} ${b})`;
        drawing.fillRect(x, 0, 1, canvas.height);
    }
}

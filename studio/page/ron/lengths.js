// Lengths with their units, as pipeline files write them: "12 mm", "52 cm", "1.2 m", "3 in".

const METRES = { mm: 0.001, cm: 0.01, m: 1, in: 0.0254, inch: 0.0254, ft: 0.3048 };

/** Metres of `"12 mm"` (with or without quotes), nothing where it is no length. */
export function metres(text) {
    const found = /^\s*"?\s*(-?[\d.]+)\s*(mm|cm|m|in|inch|ft)\s*"?\s*$/.exec(text ?? "");
    return found ? Number(found[1]) * METRES[found[2]] : null;
}

const trimmed = (value, digits) => String(Number(value.toFixed(digits)));

export const inMm = (value) => `"${trimmed(1000 * value, 1)} mm"`;
export const inCm = (value) => `"${trimmed(100 * value, 1)} cm"`;

/** A length in the unit in which `like` stands, else in millimetres. */
export function lengthLike(value, like) {
    const unit = /(mm|cm|m)\s*"?\s*$/.exec(like ?? "")?.[1] ?? "mm";
    return `"${trimmed(value / METRES[unit], 4)} ${unit}"`;
}

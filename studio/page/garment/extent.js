// The box around places in space.

/** Its lowest and highest corner, its middle and its largest side. */
export function extent(positions) {
    const [low, high] = [
        [Infinity, Infinity, Infinity],
        [-Infinity, -Infinity, -Infinity],
    ];
    for (let i = 0; i < positions.length; i++) {
        low[i % 3] = Math.min(low[i % 3], positions[i]);
        high[i % 3] = Math.max(high[i % 3], positions[i]);
    }
    return {
        low,
        high,
        middle: low.map((x, k) => (x + high[k]) / 2),
        size: Math.max(...low.map((x, k) => high[k] - x)),
    };
}

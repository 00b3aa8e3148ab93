"""Cloth: colours, patterns and prints, as periodic textures of 256 pixels.

A texture has 4 pixels per centimetre unless the caller zooms it. A third of
the pictures take theirs from real cloth, mirrored to wrap around.
"""

import cv2
import numpy as np

from . import banks

T = 256
PER_CM = 4.0
COMMON = np.array([[24, 24, 27], [26, 30, 48], [238, 238, 236], [128, 130, 133],
                   [70, 72, 78], [46, 62, 96], [170, 28, 38], [205, 190, 165],
                   [110, 24, 40], [60, 75, 55], [225, 170, 180], [130, 165, 205],
                   [235, 205, 60], [25, 110, 70], [100, 60, 40], [215, 90, 40],
                   [90, 60, 120], [40, 130, 160], [15, 50, 150], [190, 195, 200]], np.float32)
ODDS = np.array([15, 10, 11, 8, 5, 8, 5, 4, 3, 3, 4, 5, 2, 2, 2, 2, 2, 2, 3, 3], float)
FONTS = (cv2.FONT_HERSHEY_SIMPLEX, cv2.FONT_HERSHEY_DUPLEX, cv2.FONT_HERSHEY_TRIPLEX,
         cv2.FONT_HERSHEY_SCRIPT_COMPLEX, cv2.FONT_HERSHEY_COMPLEX)


def colour(rng):
    """A colour as clothes have it."""
    c = COMMON[rng.choice(len(COMMON), p=ODDS / ODDS.sum())] + rng.normal(0, 9, 3)
    if rng.random() < 0.12:
        c = rng.uniform(20, 235, 3)
        c = c + (c.mean() - c) * rng.uniform(0, .7)
    return np.clip(c, 8, 248).astype(np.float32)


def plain(rng, c):
    return np.full((T, T, 3), c, np.float32)


def bars(rng, n):
    """A periodic row of stripes as indices 0..n-1."""
    period = int(rng.choice([8, 16, 16, 32, 32, 64]))
    cuts = np.sort(rng.integers(1, period, n - 1))
    unit = np.searchsorted(cuts, np.arange(period), side="right")
    return np.tile(unit, T // period)


def stripes(rng, c):
    """Stripes of two or three colours, mostly across the body."""
    n = int(rng.choice([2, 2, 3]))
    cols = np.array([c] + [colour(rng) for _ in range(n - 1)])
    a = cols[bars(rng, n)][:, None, :] + np.zeros((T, T, 3), np.float32)
    return a if rng.random() < 0.75 else a.transpose(1, 0, 2)


def checks(rng, c):
    """Two crossed stripe rows, as in checked shirts."""
    n = int(rng.choice([2, 3]))
    cols = np.array([c] + [colour(rng) for _ in range(n - 1)])
    row = bars(rng, n)
    a = (cols[row][:, None, :] + cols[row][None, :, :]) / 2
    return a.astype(np.float32)


def wrap_stamp(img, draw, x, y, r):
    """A motif drawn at a place and again where it wraps around."""
    for ox in ((0, -T) if x + r > T else (0, T) if x < r else (0,)):
        for oy in ((0, -T) if y + r > T else (0, T) if y < r else (0,)):
            draw(img, int(x + ox), int(y + oy))


def motifs(rng, c):
    """Dots, flowers, stars or blots strewn over the cloth."""
    img = plain(rng, c)
    cols = [tuple(map(float, colour(rng))) for _ in range(3)]
    style = rng.choice(["dot", "flower", "blot", "leaf"])
    r = rng.uniform(1.2, 4) if style == "dot" else rng.uniform(3, 14)
    n = int(np.clip(2600 / (r * r), 14, 160))
    if style == "dot":
        k = max(3, int(T / (r * rng.uniform(3.5, 7))))
        spots = [((i + 0.5 * (j % 2)) * T / k, j * T / k) for i in range(k) for j in range(k)]
    else:
        spots = rng.uniform(0, T, (n, 2))
    for x, y in spots:
        k = cols[0] if style == "dot" else cols[rng.integers(3)]
        turn = rng.uniform(0, 6.28)

        def draw(im, px, py):
            if style == "dot":
                cv2.circle(im, (px, py), max(1, int(r)), k, -1, cv2.LINE_AA)
            elif style == "flower":
                for a in np.arange(5) * 1.2566 + turn:
                    q = (int(px + r * .6 * np.cos(a)), int(py + r * .6 * np.sin(a)))
                    cv2.circle(im, q, max(1, int(r * .42)), k, -1)
                cv2.circle(im, (px, py), max(1, int(r * .3)), cols[2], -1)
            else:
                axes = (max(1, int(r)), max(1, int(r * (0.4 if style == "leaf" else 0.8))))
                cv2.ellipse(im, (px, py), axes, np.degrees(turn), 0, 360, k, -1)
        wrap_stamp(img, draw, x, y, r * 1.2)
    return img


def camouflage(rng, c):
    """Blots of four shades, from noise cut at levels."""
    f = [banks.sample(banks.CLOUD[i], rng, T, T, rng.uniform(.7, 1.2), 0) for i in (2, 0)]
    level = (f[0] > 0.4).astype(int) + 2 * (f[1] > 0.3).astype(int)
    cols = np.array([c * k + rng.normal(0, 14, 3) for k in (1, .6, 1.35, .35)], np.float32)
    return np.clip(cols[level], 0, 255)


def denim(rng, c):
    """Blue or black denim with streaks and pale, worn areas."""
    base = np.array([rng.uniform(35, 105)] * 3) + rng.choice([[0, 12, 38], [0, 10, 26], [2, 2, 4]])
    grain = banks.sample(banks.GRAIN, rng, T, T, 1.0, np.pi / 2 * rng.integers(2))
    worn = banks.sample(banks.CLOUD[0], rng, T, T, 1.0)
    return (base + grain[..., None] * rng.uniform(3, 10) + worn[..., None] * rng.uniform(1, 8)) \
        .astype(np.float32)


def heather(rng, c):
    """Mixed yarn: fine noise on one colour."""
    g = banks.sample(banks.FINE[rng.integers(2)], rng, T, T, rng.uniform(.7, 1.3), 0)
    g = g + banks.sample(banks.GRAIN, rng, T, T, 1.0, 0)
    return c + g[..., None] * rng.uniform(4, 16)


def blocks(rng, c):
    """Wide bands of colour, two or three over the whole body."""
    cols = np.array([c, colour(rng), colour(rng)])
    row = np.clip((np.arange(T) - rng.integers(60, 110)) // rng.integers(25, 80) + 1, 0, 2)
    return cols[row][:, None, :] + np.zeros((T, T, 3), np.float32)


def lettering(rng, c):
    """Small words all over the cloth."""
    img = plain(rng, c).astype(np.uint8)
    k = tuple(map(float, colour(rng)))
    for y in range(10, T, int(rng.integers(14, 40))):
        for x in range(-20, T, 64):
            cv2.putText(img, word(rng), (x + int(rng.integers(30)), y), FONTS[rng.integers(5)],
                        rng.uniform(.3, .6), k, 1, cv2.LINE_AA)
    return img.astype(np.float32)


def word(rng):
    letters = "AEIOURSTLNMKDBCGPHYVFW0123456789"
    return "".join(letters[i] for i in rng.integers(0, 32, rng.integers(2, 8)))


def real(rng):
    """Cloth cut from a photo, mirrored so that it wraps around."""
    i = rng.integers(len(banks.REAL_CLOTHS)) if rng.random() < .1 \
        else banks.EVEN_CLOTHS[rng.integers(len(banks.EVEN_CLOTHS))]
    a = banks.REAL_CLOTHS[i]
    a = np.hstack([a, a[:, ::-1]])
    return np.vstack([a, a[::-1]]).astype(np.float32)


MAKERS = (plain, stripes, checks, motifs, camouflage, denim, heather, blocks, lettering)
CHANCES = {"trousers": (.44, .03, .05, .06, .04, .25, .11, .0, .02),
           "shirt": (.36, .14, .25, .1, .02, .07, .05, .0, .01),
           "jacket": (.55, .03, .06, .04, .05, .12, .12, .02, .01)}
OTHERS = (.41, .17, .05, .14, .03, .05, .1, .03, .02)


def texture(rng, kind):
    """The main cloth: texture, its pixels per cm, and its mean colour."""
    if banks.REAL_CLOTHS is not None and rng.random() < 0.35:
        t, per = real(rng), 3.3 * rng.uniform(0.7, 1.5)
    else:
        key = "trousers" if kind in ("trousers", "shorts", "skirt") else kind
        make = MAKERS[rng.choice(len(MAKERS), p=np.array(CHANCES.get(key, OTHERS)))]
        t, per = make(rng, colour(rng)), PER_CM * rng.uniform(0.7, 1.6)
        t = t + banks.FINE[0][:T, :T, None] * rng.uniform(0, 3)
    return np.clip(t, 4, 252).astype(np.uint8), per, t.reshape(-1, 3).mean(0)


def print_image(rng):
    """A chest print: colours and opacity, 128 pixels square."""
    n = 128
    img, alpha = np.zeros((n, n, 3), np.uint8), np.zeros((n, n), np.uint8)
    style = rng.choice(["words", "photo", "shapes", "badge"], p=[.4, .25, .25, .1])
    if style == "photo" and banks.REAL_CLOTHS is not None:
        src = banks.REAL_CLOTHS[rng.integers(len(banks.REAL_CLOTHS))]
        img[:] = cv2.resize(src, (n, n))
        if rng.random() < 0.5:
            cv2.ellipse(alpha, (64, 64), (60, int(rng.integers(35, 62))), 0, 0, 360, 255, -1)
        else:
            h = int(rng.integers(0, 30))
            alpha[h:n - h, 4:-4] = 255
    elif style == "shapes":
        for _ in range(int(rng.integers(2, 9))):
            k, c = tuple(map(float, colour(rng))), tuple(map(int, rng.integers(25, 103, 2)))
            axes = tuple(map(int, rng.integers(6, 34, 2)))
            cv2.ellipse(img, c, axes, rng.uniform(0, 180), 0, 360, k, -1)
            cv2.ellipse(alpha, c, axes, 0, 0, 360, 255, -1)
            cv2.ellipse(img, c, axes, 0, 0, 360, k, -1)
    if style in ("words", "badge") or rng.random() < 0.35:
        k, f = tuple(map(float, colour(rng))), FONTS[rng.integers(5)]
        for y in range(40, 120, int(rng.integers(26, 60))):
            w, s = word(rng), rng.uniform(.5, 1.4) if style != "badge" else .5
            x = int(64 - cv2.getTextSize(w, f, s, 2)[0][0] / 2)
            thick = int(rng.integers(2, 5))
            cv2.putText(img, w, (x, y), f, s, k, thick + 1)
            cv2.putText(alpha, w, (x, y), f, s, 255, thick, cv2.LINE_AA)
            if style == "badge":
                break
    return np.dstack([img, alpha * (rng.uniform(0.75, 1) / 255)]).astype(np.float32)

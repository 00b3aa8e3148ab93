"""Grounds: what a garment lies on or hangs against, at the picture's size.

Half come from rims of real photos, half are made: planks, tiles, carpet,
linen with folds, patterned blankets, plain, grass, doors.
"""

import cv2
import numpy as np

from . import banks, cloth

TONES = {
    "wood": ([196, 150, 96], [150, 104, 62], [120, 78, 48], [205, 180, 145], [170, 165, 158],
             [92, 62, 42], [222, 205, 178]),
    "tile": ([225, 220, 208], [205, 195, 178], [170, 165, 160], [238, 236, 232], [120, 118, 115]),
    "linen": ([235, 232, 228], [215, 205, 195], [150, 40, 50], [180, 195, 215], [240, 225, 190],
              [90, 95, 120], [225, 180, 185], [170, 150, 130]),
    "carpet": ([180, 172, 160], [120, 112, 105], [90, 60, 50], [205, 198, 185], [130, 40, 45],
               [70, 75, 80], [150, 130, 100]),
    "wall": ([225, 222, 215], [205, 200, 190], [235, 230, 220], [170, 175, 180], [215, 205, 170],
             [110, 70, 45], [150, 105, 70]),
    "grass": ([85, 110, 50], [100, 120, 60])}


def tone(rng, name):
    t = TONES[name]
    return np.clip(np.array(t[rng.integers(len(t))], np.float32) * rng.uniform(.85, 1.12)
                   + rng.normal(0, 6, 3), 10, 250).astype(np.float32)


def view(tex, rng, w, h, tilt, scale, turn=0.25):
    """A texture laid on the ground plane and seen by the camera."""
    a = rng.choice([0, np.pi / 2]) + rng.normal(0, turn)
    c, s = np.cos(a) / scale, np.sin(a) / scale
    u, v = rng.uniform(0, tex.shape[1]), rng.uniform(0, tex.shape[0])
    m = np.array([[c, -s, u], [s, c, v], [0, tilt / h, 1]])
    border = cv2.BORDER_REFLECT if tex.shape[0] == banks.GROUND else cv2.BORDER_WRAP
    return cv2.warpPerspective(tex, m, (w, h), borderMode=border,
                               flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP)


def planks(rng):
    """Boards of different shades with grain, joints and ends."""
    n, base = 384, tone(rng, "wood")
    img = np.empty((n, n, 3), np.float32)
    wide = int(rng.choice([24, 32, 48, 64, 96]))
    grain = banks.sample(banks.GRAIN, rng, n, n, rng.uniform(.8, 2), np.pi / 2)
    long = banks.sample(banks.BROAD[2], rng, n, n, 1.5, np.pi)
    spread, joint = rng.uniform(3, 16), rng.uniform(.35, .85)
    img[:] = base + (grain * rng.uniform(2, 7) + long * rng.uniform(1, 6))[..., None]
    for x in range(0, n, wide):
        ends = [0] + sorted(rng.integers(40, n - 40, rng.integers(1, 3))) + [n]
        for y0, y1 in zip(ends[:-1], ends[1:]):
            img[y0:y1, x:x + wide] += rng.normal(0, spread)
            img[y0:y0 + 1, x:x + wide] *= joint
        img[:, x:x + (2 if joint < .5 else 1)] *= joint
    return np.ascontiguousarray(img, np.float32)


def tiles(rng):
    """Square or long tiles with joints, some marbled."""
    n, base = 384, tone(rng, "tile")
    cloud = banks.sample(banks.CLOUD[0], rng, n, n, rng.uniform(.5, 1.5))
    img = base + cloud[..., None] * rng.uniform(1, 9)
    a, b = int(rng.choice([64, 96, 128, 192])), int(rng.choice([64, 96, 128, 192]))
    b = a if rng.random() < .7 else b
    joint = base * rng.uniform(.5, 1.1)
    for y in range(0, n, a):
        img[y:y + int(rng.integers(2, 4))] = joint
    for x in range(0, n, b):
        img[:, x:x + 3] = joint
    return np.ascontiguousarray(img, np.float32)


def carpet(rng):
    """Pile or weave: strong fine noise, sometimes with shapes."""
    n, base = 384, tone(rng, "carpet")
    fine = banks.sample(banks.FINE[rng.integers(2)], rng, n, n, rng.uniform(.8, 2.5))
    cloud = banks.sample(banks.CLOUD[2], rng, n, n, 1.0)
    img = base + (fine * rng.uniform(6, 24) + cloud * rng.uniform(1, 8))[..., None]
    if rng.random() < .3:
        other = tone(rng, "carpet") - base
        mask = np.sin(np.hypot(*(np.mgrid[0:n, 0:n] % 128 - 64)) * rng.uniform(.1, .3)) > .2
        img += other * cv2.blur(mask.astype(np.float32), (5, 5))[..., None] * .8
    return np.ascontiguousarray(img, np.float32)


def linen(rng):
    """A sheet or blanket with folds, plain or patterned."""
    n = 384
    if rng.random() < .4:
        make = cloth.MAKERS[rng.choice([1, 2, 3, 3, 3])]
        img = np.tile(make(rng, tone(rng, "linen")), (2, 2, 1))[:n, :n]
        img = img * .75 + img.mean((0, 1)) * .25
    else:
        img = np.full((n, n, 3), tone(rng, "linen"), np.float32)
    fold = banks.sample(banks.BROAD[rng.integers(3)], rng, n, n, rng.uniform(1, 2.5)) \
        * rng.uniform(.01, .06)
    fold += banks.sample(banks.CREASE[rng.integers(4)], rng, n, n, rng.uniform(1, 2.5)) \
        * rng.uniform(.0, .05)
    return img * (1 + fold[..., None])


def grass(rng):
    n = 384
    g = banks.sample(banks.GRAIN, rng, n, n, 1.2) + banks.sample(banks.GRAIN, rng, n, n, 1.4)
    return tone(rng, "grass") * (1 + .28 * g[..., None])


def plainly(rng):
    n = 384
    cloud = banks.sample(banks.CLOUD[0], rng, n, n, 2.0)
    fine = banks.sample(banks.FINE[0], rng, n, n, 1.0)
    base = tone(rng, rng.choice(["wall", "linen", "tile"]))
    return base + (cloud * rng.uniform(0, 4) + fine * rng.uniform(0, 3))[..., None]


def wall(rng, w, h):
    """A wall, door or wardrobe behind a hung garment."""
    base = tone(rng, "wall")
    img = np.empty((h, w, 3), np.float32)
    cloud = banks.sample(banks.CLOUD[1], rng, w, h, 1.5)
    grain = banks.sample(banks.GRAIN, rng, w, h, 1.5, np.pi / 2)
    img[:] = base + (cloud * 3 + grain * rng.uniform(0, 3))[..., None]
    if rng.random() < .6:
        for _ in range(int(rng.integers(1, 4))):
            x, t = int(rng.uniform(0, w)), int(rng.integers(1, 5))
            img[:, x:x + t] *= rng.uniform(.5, .85)
            img[:, x + t:x + t + 2] *= 1.08
        if rng.random() < .5:
            x0, y0 = int(w * rng.uniform(.05, .2)), int(h * rng.uniform(.05, .5))
            for k, f in ((0, .8), (2, 1.1)):
                cv2.rectangle(img, (x0 + k, y0 + k), (w - x0 - k, int(h * 1.1)),
                              tuple(map(float, base * f)), 2)
    return np.ascontiguousarray(img, np.float32)


MADE = (planks, tiles, carpet, linen, grass, plainly)
ODDS = (.26, .13, .2, .27, .02, .12)


def ground(rng, w, h, tilt, hung, match=None):
    """The ground as float32 RGB of h by w; match pulls its colour to a garment's."""
    if hung and rng.random() < .75:
        img = wall(rng, w, h)
    elif banks.REAL_GROUNDS is not None and rng.random() < .55:
        tex = np.array(banks.REAL_GROUNDS[rng.integers(len(banks.REAL_GROUNDS))])
        img = view(tex, rng, w, h, tilt, max(w, h) / 341 * rng.uniform(.9, 1.6), .15)
        img = img.astype(np.float32)
    else:
        tex = MADE[rng.choice(len(MADE), p=ODDS)](rng)
        tex = np.clip(tex, 0, 255).astype(np.uint8)
        img = view(tex, rng, w, h, tilt, max(w, h) / 384 * rng.uniform(.45, 1.3)).astype(np.float32)
    if match is not None:
        img += ((match - img.mean((0, 1))) * rng.uniform(.6, .95)).astype(np.float32)
    return np.ascontiguousarray(img, np.float32)

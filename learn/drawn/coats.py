"""Hoodies, jackets, blazers and coats, closed or with an open front."""

import numpy as np

from .shapes import arr, bez, both, neckline, plate
from .basics import (SIDES, add_sleeves, armhole, chance, hem_line, side_line,
                     sleeve_measures, start, top_marks, top_measures, torso)
from .tops import high_neck, inside_piece, leaf_collar, wide_rib


def hood(rng, m):
    """A hood laid up above the neck, or folded back around it."""
    nw, k = m["nw"], m["cw"] / 26
    if chance(rng, 0.6):
        h, w = rng.uniform(24, 34) * k, nw * rng.uniform(1.35, 1.9)
        right = np.vstack([bez((nw * 1.15, 1.5 * k), (w * 1.1, -h * 0.2), (w, -h * 0.5)),
                           bez((w, -h * 0.5), (w * 0.9, -h * 0.95), (0, -h))[1:]])
        shell = plate("hood", np.vstack([both(right), arr((0, m["depth"]))]), lift=1.2)
        if chance(rng, 0.25):
            edge = bez((0, m["depth"]), (-nw * .3, -h * .5), (nw * .2, -h))
            shell.lines.append((edge, 90, .4, False))
            return [shell], []
        v = rng.uniform(0.5, 0.85)
        r2 = np.vstack([bez((nw * 0.85, 1.0), (w * 0.85, -h * 0.3), (w * 0.7, -h * 0.5)),
                        bez((w * 0.7, -h * 0.5), (w * 0.6, -h * v), (0, -h * v))[1:]])
        hole = plate("inside", np.vstack([both(r2), arr((0, m["depth"]))]), cloth="lining",
                     dim=rng.uniform(0.5, 0.8), lift=0.7)
        return [shell, hole], []
    h, w = rng.uniform(6, 12) * k, nw + rng.uniform(3, 7) * k
    right = np.vstack([bez((nw * 0.3, m["depth"] + 4 * k), (w, m["depth"]), (w, 0)),
                       bez((w, 0), (w * 0.9, -h), (0, -h))[1:]])
    ring = plate("hood", both(right), lift=1.3)
    r2 = np.vstack([bez((0.2, m["depth"] + k), (nw, m["depth"] * .6), (nw * 0.9, -0.5)),
                    bez((nw * 0.9, -0.5), (nw * 0.6, -h * 0.35), (0, -h * 0.35))[1:]])
    hole = plate("inside", both(r2), cloth="lining", dim=0.75, lift=0.8)
    return [], [ring, hole]


def make_hoodie(rng, kind, hung):
    """Hoodies with pocket, cords, and sometimes a zip."""
    g = start(rng, kind)
    m = top_measures(rng, kind)
    q = sleeve_measures(rng, m, kind)
    before, after = add_sleeves(rng, g, m, q, hung)
    body = plate("body", torso(m, q["seam"]))
    top_marks(g, m)
    body.lines += [(armhole(m, q["seam"]) * np.array([s, 1]), 95, 0.3, False) for s, _ in SIDES]
    under, above = hood(rng, m)
    front_details(rng, m, body, zipped=chance(rng, 0.5))
    g.pieces = before + [inside_piece(rng, m)] + under + [body, wide_rib(rng, g, m, body)] \
        + above + after
    if chance(rng, 0.6):
        cords = above[0] if above else body
        for s, _ in SIDES:
            cords.lines.append((bez((s * m["nw"] * 0.4, m["depth"]), (s * 3, m["ad"] * .7),
                                    (s * rng.uniform(1, 4), m["ad"] * rng.uniform(.8, 1.3))),
                                rng.choice([30, 220]), 0.7, False))
    g.print_box = (0, m["ad"] * 0.95, m["cw"] * rng.uniform(0.3, 0.6)) if chance(rng, .6) else None
    g.m = m
    return g


def front_details(rng, m, body, zipped):
    """A zip or a placket down the front, and pockets at the belly."""
    k, L = m["cw"] / 26, m["length"]
    if zipped:
        body.lines.append((arr((0, m["depth"]), (0, L)), rng.choice([40, 70, 200]), 1.1 * k, False))
        body.lines.append((arr((0, m["depth"]), (0, L)), 110, 0.3 * k, False))
    y0, y1, x = L - rng.uniform(22, 26) * k, L - 6 * k, m["cw"] * 0.62
    for s, _ in SIDES:
        f = np.array([s, 1])
        body.lines.append((arr((x * 0.55, y0), (x, y0 + 11 * k)) * f, 85, 0.4, False))
        if not zipped or chance(rng, 0.5):
            body.lines.append((arr((0, y0), (x * 0.55, y0)) * f, 100, 0.3, False))
            body.lines.append((arr((x, y0 + 11 * k), (x, y1), (0, y1)) * f, 100, 0.3, False))


def lapels(rng, m):
    """A notched collar of a blazer or coat: two big leaves and the stand."""
    nw, d, k = m["nw"], m["depth"], m["cw"] / 26
    wide = rng.uniform(1.5, 2.1)
    pieces = [plate("collar", np.vstack([bez((-nw, -2.5 * k), (0, -4 * k), (nw, -2.5 * k)),
                                         bez((nw, .5), (0, 1.5 * k), (-nw, .5))]), dim=.9)]
    for s, _ in SIDES:
        leaf = np.vstack([bez((nw * 0.85, -2.5 * k), (nw * 0.8, d * 0.3), (0.2, d)),
                          arr((nw * wide, d * 0.48), (nw * wide * 0.82, d * 0.36),
                              (nw * wide * 0.92, d * 0.22), (nw * 1.25, 0))])
        p = plate("collar", leaf * np.array([s, 1]), lift=1.0)
        p.lines.append((arr((nw * wide * 0.82, d * 0.36), (nw * 0.6, d * 0.25))
                        * np.array([s, 1]), 85, 0.3, False))
        pieces.append(p)
    return pieces


def make_jacket(rng, kind, hung):
    """Jackets, blazers and coats, closed or with an open front."""
    g = start(rng, kind)
    m = top_measures(rng, kind)
    m["length"] *= rng.choice([1.0, 1.0, 1.4])
    style = rng.choice(["blazer", "zip", "shirt", "hood"], p=[0.35, 0.3, 0.2, 0.15])
    if style == "blazer":
        m["depth"], m["power"] = m["length"] * rng.uniform(0.35, 0.6), 1.1
    else:
        m["depth"], m["power"] = m["nw"] * rng.uniform(0.6, 1.2), 2.0
    m["back"] = 0.3
    q = sleeve_measures(rng, m, kind)
    before, after = add_sleeves(rng, g, m, q, hung)
    top_marks(g, m)
    opened = chance(rng, 0.3)
    bodies = open_front(rng, m) if opened else [plate("body", torso(m))]
    body = bodies[0]
    for b in bodies:
        b.lines += [(armhole(m) * np.array([s, 1]), 92, 0.35, False) for s, _ in SIDES]
    if style == "blazer" and not opened:
        body.lines.append((arr((1, m["depth"]), (1.5, m["length"])), 70, 0.5, False))
        for y in np.linspace(m["depth"] + 1, m["depth"] + 14, rng.integers(1, 4)):
            body.dots.append((0.4, y, 0.9, rng.choice([50, 210])))
        front_flaps(rng, m, body)
    elif not opened:
        front_details(rng, m, body, zipped=True)
        if chance(rng, 0.25):
            quilt(rng, m, body)
    neck, hooded = [], []
    if style == "blazer":
        neck = lapels(rng, m)
    elif style == "shirt":
        neck = leaf_collar(rng, m, False)
    elif style == "zip":
        neck = high_neck(rng, m)
    else:
        hooded, neck = hood(rng, m)
    w, low = m["nw"] * 1.2, m["length"] - 3
    inner = plate("inside", np.vstack([neckline(m["nw"], .3, 2), arr((w, low), (-w, low))]),
                  cloth="lining", dim=rng.uniform(.5, .9))
    g.pieces = before + [inner] + hooded + bodies + neck + after
    g.m = m
    return g


def front_flaps(rng, m, body):
    """The pocket flaps of a blazer."""
    k = m["cw"] / 26
    for s, _ in SIDES:
        x, y = m["cw"] * 0.55, m["length"] * 0.66
        body.lines.append((arr((x - 7 * k, y), (x + 7 * k, y - k), (x + 7 * k, y + 5 * k),
                               (x - 7 * k, y + 5 * k), (x - 7 * k, y)) * np.array([s, 1]),
                           90, 0.3, False))


def quilt(rng, m, body):
    """The seams of a quilted jacket."""
    step = rng.uniform(5, 10)
    for y in np.arange(m["ad"] * 0.5, m["length"], step):
        x = float(side_line(m)(max(y, m["ad"])))
        body.lines.append((bez((-x, y), (0, y + 1), (x, y)), 82, 0.7, False))


def open_front(rng, m):
    """Two fronts with a gap between them."""
    out = []
    hole, edge, hem = armhole(m), side_line(m), hem_line(m)
    y = np.linspace(m["ad"], hem[0, 1], 10)[1:-1]
    for side, _ in SIDES:
        gap0 = rng.uniform(0, 0.5) * m["nw"]
        gap1 = rng.uniform(-0.3, 1.2) * m["nw"]
        top = bez((m["nw"], 0), (m["nw"] * 0.9, m["depth"] * .5), (gap0, m["depth"]))
        half = hem[:len(hem) // 2 + 1].copy()
        half = half[half[:, 0] > gap1 + 1]
        side_pts = np.stack([edge(y), y], 1)
        shape = np.vstack([hole, side_pts, half, arr((gap1, m["length"])),
                           top[::-1]])
        out.append(plate("body", shape * np.array([side, 1])))
    return out

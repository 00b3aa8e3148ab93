"""T-shirts, polos, long sleeves, shirts, sleeveless tops and dresses."""

import numpy as np

from .shapes import arr, bez, mirror, neckline, plate
from .basics import (SIDES, add_sleeves, armhole, button_line, chance, gathers,
                     hem_details, hem_line, side_line, sleeve_measures, start,
                     top_marks, top_measures, torso)


def inside_piece(rng, m, drop=2.0):
    """The inner back, seen through the neck opening."""
    low = max(m["depth"], m["back"]) + drop
    back = neckline(m["nw"], m["back"], 2.4)
    shape = np.vstack([back, arr((m["nw"], low), (-m["nw"], low))])
    p = plate("inside", shape, cloth="lining", dim=rng.uniform(0.6, 0.9))
    if chance(rng, 0.6):
        w, y = m["nw"] * 0.22, m["back"] + 0.6
        for k in range(2):
            p.lines.append((arr((-w, y + k), (w, y + k)), rng.choice([60, 200]), 1.0, False))
    return p


def neck_lines(rng, m, body):
    """The rim or rib along the neckline."""
    w = rng.uniform(0.8, 2.6) * m["cw"] / 26
    k = (m["nw"] + w) / m["nw"]
    line = neckline(m["nw"] * k, m["depth"] + w, m["power"])
    body.lines.append((line[1:-1], rng.choice([95, 110, 144]), 0.25, False))
    return line


def wide_rib(rng, g, m, body):
    """A ribbed band at the hem of sweaters, hoodies and jackets."""
    up = rng.uniform(3.5, 7) * m["cw"] / 26
    hem = hem_line(m)
    top = hem - np.array([0, up], np.float32)
    p = plate("body", np.vstack([hem, top[::-1]]), cloth=g.rib_cloth, join=True, lift=0.6)
    for x in np.linspace(-0.96, 0.96, 28):
        i = x * m["hw"]
        p.lines.append((arr((i, m["length"] - up), (i, m["length"])), 114, 0.3, False))
    body.lines.append((top, 90, 0.35, False))
    return p


def leaf_collar(rng, m, soft):
    """A shirt's or polo's collar: the stand behind and two leaves in front."""
    k, nw, d = m["cw"] / 26, m["nw"], m["depth"]
    rise = rng.uniform(1.5, 4) * k
    spread, drop = rng.uniform(0.45, 1.15), rng.uniform(2.5, 5.5) * k
    lower = bez((nw * 0.95, 0.6), (0, m["back"] + 1.5), (-nw * 0.95, 0.6))
    upper = bez((-nw * 0.8, -rise), (0, -rise - k), (nw * 0.8, -rise))
    stand = plate("collar", np.vstack([upper, lower]), dim=0.88, cloth="collar")
    gap = rng.choice([0.3, rng.uniform(0.5, 2.5)]) * k
    pieces = [stand]
    for side, _ in SIDES:
        tip = (nw * spread + gap, d + drop * (0.8 if soft else 1))
        inner = bez((nw * 0.72, -rise), (nw * 0.75, d * 0.35), (gap, d))
        outer = bez(tip, (nw * 1.25, d * 0.55), (nw + 1.6 * k, 1.2 * k))
        back = bez((nw + 1.6 * k, 1.2 * k), (nw * 1.15, -rise * 0.7), (nw * 0.72, -rise))
        leaf = plate("collar", np.vstack([inner, outer, back]) * np.array([side, 1]),
                     cloth="collar", lift=0.9)
        leaf.lines.append((np.vstack([arr((gap, d)), arr(tip), outer])[:-2]
                           * np.array([side, 0.97]), 110, 0.15, False))
        pieces.append(leaf)
    return pieces


def pockets(rng, m, body, tone=100):
    """Breast pockets with a stitched edge."""
    k = m["cw"] / 26
    for side in ((1,), (-1,), (-1, 1))[rng.integers(3)]:
        x, y, w, h = side * m["cw"] * 0.45, m["ad"] * 0.95, 5.5 * k, 12 * k
        box = arr((x - w, y), (x - w, y + h), (x, y + h * 1.12), (x + w, y + h), (x + w, y))
        body.lines.append((np.vstack([box, box[:1]]), tone, 0.25, False))
        if chance(rng, 0.3):
            body.lines.append((arr((x - w, y + h * .3), (x, y + h * .42), (x + w, y + h * .3)),
                               tone, 0.25, False))


def make_top(rng, kind, hung):
    """T-shirts, polos, long sleeves, shirts, hoodies and closed jackets."""
    g = start(rng, kind)
    m = top_measures(rng, kind)
    if kind in ("polo", "shirt"):
        m["depth"] = m["nw"] * rng.uniform(0.5, 1.3)
        m["back"] = 0.2
        m["power"] = rng.choice([1.1, 1.8])
    q = sleeve_measures(rng, m, kind)
    before, after = add_sleeves(rng, g, m, q, hung)
    body = plate("body", torso(m, q["seam"]))
    top_marks(g, m)
    body.lines += [(armhole(m, q["seam"]) * np.array([s, 1]), rng.choice([95, 108, 114, 142]),
                    0.25, False) for s, _ in SIDES]
    hem_details(rng, m, body)
    front = []
    if kind == "tshirt" or kind == "longsleeve":
        neck_lines(rng, m, body)
        g.print_box = (0, m["ad"] * 0.95, m["cw"] * rng.uniform(0.35, 0.75))
    if kind == "longsleeve" and chance(rng, 0.5):
        front.append(wide_rib(rng, g, m, body))
    if kind == "longsleeve" and chance(rng, 0.15):
        front += high_neck(rng, m)
    if kind == "longsleeve" and chance(rng, 0.15):
        button_line(rng, m, body, m["depth"], m["length"], 6)
    if kind in ("polo", "shirt"):
        front += leaf_collar(rng, m, kind == "polo")
        end = m["length"] if kind == "shirt" else m["depth"] + m["cw"] * rng.uniform(.4, .6)
        button_line(rng, m, body, m["depth"], end, rng.integers(5, 9) if kind == "shirt" else 3)
        if chance(rng, 0.4):
            pockets(rng, m, body)
    g.pieces = before + [inside_piece(rng, m), body] + front[:0] + after
    g.pieces[len(before) + 2:len(before) + 2] = front
    g.m = m
    return g


def high_neck(rng, m):
    """A turtleneck or stand collar above the neck points."""
    h = rng.uniform(3, 9) * m["cw"] / 26
    nw = m["nw"]
    top = bez((-nw * 0.88, -h), (0, -h + 1.2), (nw * 0.88, -h))
    low = bez((nw * 1.05, 0.3), (0, 2 * m["depth"] + 0.5), (-nw * 1.05, 0.3))
    tube = plate("collar", np.vstack([top, low]), cloth="collar")
    behind = plate("inside", np.vstack([top, bez((nw * .88, -h), (0, -h - 1.5), (-nw * .88, -h))]),
                   cloth="lining", dim=0.7)
    return [behind, tube]


def make_sleeveless(rng, kind, hung):
    """Vests, tank tops and strap tops; also the upper part of dresses."""
    g = start(rng, kind)
    m = top_measures(rng, kind)
    cw = m["cw"]
    style = rng.choice(["vest", "tank", "strap", "gilet"], p=[0.35, 0.35, 0.22, 0.08])
    strap = {"vest": rng.uniform(0.18, 0.36), "tank": rng.uniform(0.1, 0.22),
             "strap": rng.uniform(0.025, 0.07), "gilet": rng.uniform(0.3, 0.4)}[style] * cw
    m["nw"] = cw * rng.uniform(0.36, 0.55)
    m["sw"] = m["nw"] + strap
    m["slope"] = strap * rng.uniform(0.1, 0.35)
    m["depth"] = m["nw"] * rng.uniform(0.6, 1.7)
    m["power"] = rng.choice([1.1, 2.4, 3.5])
    m["back"] = m["depth"] * rng.uniform(0.15, 0.9)
    if style == "strap":
        m["ad"] = cw * rng.uniform(0.75, 0.95)
        m["depth"], m["power"] = m["ad"] * rng.uniform(0.75, 1.0), rng.choice([4.0, 9.0])
        m["back"] = m["ad"] * rng.uniform(0.7, 0.95)
    if style == "gilet":
        m["depth"] = m["nw"]
    g.style = style
    body = plate("body", torso(m, "bare"))
    top_marks(g, m)
    if style != "strap":
        neck_lines(rng, m, body)
        for s, _ in SIDES:
            line = armhole(m, "bare") - np.array([0.9, -0.3])
            body.lines.append((line * np.array([s, 1]), 112, 0.2, False))
    hem_details(rng, m, body)
    if style == "gilet":
        body.lines.append((arr((0, m["depth"]), (0, m["length"])), 60, 0.6, False))
    back = bare_back(rng, m)
    g.print_box = (0, m["ad"] * 1.05, cw * rng.uniform(0.35, 0.6))
    g.pieces = [back, body] + (high_neck(rng, m) if style == "gilet" else [])
    g.m = m
    return g


def bare_back(rng, m):
    """The inner back of a sleeveless top, also seen beside its straps."""
    back = neckline(m["nw"], m["back"], rng.choice([2.2, 3.5]))
    deep = dict(m, ad=m["ad"] * rng.uniform(0.85, 1.0))
    hole = armhole(deep, "bare")
    low = arr((m["cw"] * 0.9, m["ad"] + 3), (-m["cw"] * 0.9, m["ad"] + 3))
    shape = np.vstack([back, hole * 0.995, low, mirror(hole * 0.995)[::-1]])
    return plate("inside", shape, cloth="lining", dim=rng.uniform(0.65, 0.9))


def make_dress(rng, kind, hung):
    """Dresses: a top with or without sleeves and a long body."""
    bare = chance(rng, 0.55)
    g = make_sleeveless(rng, "dress", hung) if bare else make_top(rng, "dress", hung)
    m = g.m
    m["length"] = m["cw"] * rng.uniform(3.1, 5.2)
    flare = chance(rng, 0.6)
    m["hw"] = m["cw"] * (rng.uniform(1.3, 2.4) if flare else rng.uniform(0.85, 1.2))
    m["flare"] = rng.uniform(1.0, 1.7) if flare else 1.0
    m["nip"] = m["cw"] * rng.uniform(0, 0.2)
    m["hem"] = "round" if flare else "plain"
    m["tail"] = m["cw"] * rng.uniform(0.1, 0.5)
    if flare and chance(rng, 0.5):
        m.update(wave=rng.uniform(0.3, 1.5), waves=rng.uniform(8, 20), phase=rng.uniform(0, 6))
    i = [k for k, p in enumerate(g.pieces) if p.part == "body"][0]
    body = plate("body", torso(m, "bare" if bare else "set"))
    body.lines = [l for l in g.pieces[i].lines if l[0][:, 1].max() < m["ad"] * 1.4]
    g.pieces[i] = body
    top_marks(g, m)
    hem_details(rng, m, body)
    if chance(rng, 0.6):
        y = m["cw"] * rng.uniform(1.3, 1.9)
        x = side_line(m)(y)
        body.lines.append((bez((-x, y), (0, y + 1), (x, y)), 85, 0.4, False))
        gathers(rng, g, body, x, y, m["length"], m["hw"], 7)
    if chance(rng, 0.15):
        button_line(rng, m, body, m["depth"], m["length"], 9)
    g.print_box = None
    return g

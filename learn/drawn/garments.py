"""All kinds of garments by name, one-pieces, hangers and things on top.

make() returns a Garment in centimetres: pieces in drawing order, landmarks,
how the limbs lie, and the points that folds run from.
"""

import numpy as np

from .shapes import Piece, arr, bez, both, mirror, neckline, plate
from .basics import SIDES, armhole, chance, side_line
from .legs import add_legs, make_legs, make_skirt
from .tops import make_dress, make_sleeveless, make_top
from .coats import make_hoodie, make_jacket


def make_onepiece(rng, kind, hung):
    """Baby bodies with a snap crotch, rompers and jumpsuits with legs."""
    legged = chance(rng, 0.45)
    bare = chance(rng, 0.2)
    g = make_sleeveless(rng, kind, hung) if bare else make_top(rng, kind, hung)
    m = g.m
    m["length"] = m["cw"] * rng.uniform(2.3, 2.9)
    m["hw"], m["hem"], m["nip"] = m["cw"] * rng.uniform(0.88, 1.06), "plain", 0.0
    i = [k for k, p in enumerate(g.pieces) if p.part == "body"][0]
    seam = "bare" if bare else "set"
    body = Piece("body", [], [], lines=[l for l in g.pieces[i].lines
                                        if l[0][:, 1].max() < m["ad"] * 1.3], join=legged)
    g.pieces = [p for k, p in enumerate(g.pieces) if k <= i or p.part != "body"]
    neck, hole = neckline(m["nw"], m["depth"], m["power"]), armhole(m, seam)
    edge, L = side_line(m), m["length"]
    for key in ("hem_left", "hem_right"):
        g.marks.pop(key, None)
    if legged:
        y = np.linspace(m["ad"], L * 0.97, 8)[1:]
        right = np.vstack([hole, np.stack([edge(y), y], 1)])
        low = arr((0, L))
        t = dict(hip=m["hw"], rise=L, k=m["cw"] / 26, length=m["cw"] * rng.uniform(0.5, 2.6),
                 hem=m["hw"] * rng.uniform(0.5, 0.85))
        t["rise"] = L
        legs, over = add_legs(rng, g, dict(t, rise=L), False)
        front_line(rng, m, body, L)
    else:
        y = np.linspace(m["ad"], L * 0.74, 7)[1:]
        c = m["cw"] * rng.uniform(0.22, 0.34)
        cut = bez((m["hw"], L * 0.74), (c * 1.3, L * 0.8), (c, L))
        right = np.vstack([hole, np.stack([edge(y), y], 1), cut])
        low = arr((c, L), (-c, L))
        legs, over = [], []
        for s, name in SIDES:
            g.marks["hem_" + name] = arr(s * c, L)
            body.lines.append(((cut - np.array([0.8, 0.4])) * np.array([s, 1]), 105, 0.25, False))
        body.dots += [(x, L - 1.2, 0.5, 200) for x in (-c * .6, 0, c * .6)]
        body.lines.append((arr((-c, L - 2.4), (c, L - 2.4)), 95, 0.25, False))
    shape = np.vstack([neck, right, low, mirror(right)[::-1]]).astype(np.float32)
    body.polys, body.flat = [shape], [shape]
    g.pieces[i:i + 1] = legs + [body] + over
    return g


def front_line(rng, m, body, low):
    """A zip or snaps down the front of a romper."""
    if chance(rng, 0.5):
        body.lines.append((arr((0, m["depth"]), (0, low)), 80, 0.5, False))
    else:
        body.dots += [(0, y, 0.6, 210) for y in np.linspace(m["depth"] + 2, low - 2, 6)]


MAKERS = dict(tshirt=make_top, polo=make_top, longsleeve=make_top, shirt=make_top,
              sleeveless=make_sleeveless, dress=make_dress, skirt=make_skirt,
              trousers=make_legs, shorts=make_legs, jacket=make_jacket,
              hoodie=make_hoodie, onepiece=make_onepiece)


def add_hanger(rng, g):
    """A hanger: behind the front of tops, clips at the waist of the rest."""
    g.hanger = True
    tone = "metal" if chance(rng, 0.4) else "dark"
    if "neck_left" not in g.marks:
        w = float(g.marks["waist_right"][0])
        pieces = [plate("hanger", arr((-w, -5), (w, -5), (w, -4), (-w, -4)), cloth=tone)]
        for x in (-w * 0.8, w * 0.8):
            pieces.append(plate("hanger", arr((x - 1.2, -5.5), (x + 1.2, -5.5), (x + 1.4, 2),
                                              (x - 1.4, 2)), cloth=tone))
        y0 = -5
    else:
        sw, sl = g.marks["shoulder_right"]
        t = rng.uniform(0.9, 2.2)
        bar = np.vstack([bez((0, -2.5), (sw * 0.5, -1), (sw * 0.93, sl + 1))])
        thick = bar + np.array([0, t])
        pieces = [plate("hanger", np.vstack([both(bar), both(thick)[::-1]]), cloth=tone)]
        y0 = -2
    pieces.append(hook(rng, y0, tone))
    at = next((i + 1 for i, p in enumerate(g.pieces) if p.part in ("inside",)), 0)
    if "neck_left" not in g.marks:
        at = len(g.pieces)
    g.pieces[at:at] = pieces


def hook(rng, y0, tone):
    """The hook of a hanger."""
    r = rng.uniform(1.8, 3)
    a = np.linspace(np.pi * 0.5, -np.pi, 14)
    top = y0 - rng.uniform(3, 7)
    mid = np.vstack([arr((0, y0), (0, top)),
                     np.stack([r * np.cos(a), top - r * 1.0 - r * np.sin(-a) * -1], 1)])
    mid = mid.astype(np.float32)
    polys = []
    for p, q in zip(mid[:-1], mid[1:]):
        d = q - p
        n = np.array([-d[1], d[0]]) / (np.hypot(*d) + 1e-6) * 0.35
        polys.append(np.stack([p + n, q + n, q - n, p - n]).astype(np.float32))
    return Piece("hanger", polys, polys, cloth="metal" if tone == "metal" else tone, lift=0.5)


def make(rng, kind, hung=False):
    """A garment of a kind with a random shape, lying in a random way."""
    g = MAKERS[kind](rng, kind, hung)
    g.flat = not {"over", "folded"} & set(g.lies.values())
    if hung:
        add_hanger(rng, g)
    if chance(rng, 0.03):
        x, y = rng.uniform(-8, 8), rng.uniform(15, 35)
        a, w, h = rng.uniform(0, 3), rng.uniform(1.5, 3), rng.uniform(3, 6)
        c, s = np.cos(a), np.sin(a)
        box = arr((-w, -h), (w, -h), (w, h), (-w, h)) @ arr((c, s), (-s, c)) + arr(x, y)
        g.pieces.append(plate("hanger", box, cloth="paper"))
    return g

"""Measures, outlines and sleeves that all tops share, in centimetres.

x runs right, y down; the neck points lie at y = 0. Sleeves lie apart from the
body, beside it, over it or folded away; the word for how a sleeve lies is
judged from the shape that came out.
"""

import numpy as np

from .shapes import (Garment, Piece, arr, bent, bez, folded_on, hanging, mirror,
                     neckline, smooth)

SIDES = ((-1, "left"), (1, "right"))


def chance(rng, p):
    return rng.random() < p


def top_measures(rng, kind):
    """Random measures of a top, all from half the chest's width."""
    cw = rng.uniform(13, 21) if chance(rng, 0.35) else rng.uniform(21, 33)
    m = dict(cw=cw, age="child" if cw < 21 else "adult")
    drop = chance(rng, 0.2)
    m["sw"] = cw * (rng.uniform(0.95, 1.06) if drop else rng.uniform(0.74, 0.92))
    m["nw"] = cw * rng.uniform(0.28, 0.4)
    m["ad"] = cw * rng.uniform(0.8, 1.02)
    m["slope"] = (m["sw"] - m["nw"]) * rng.uniform(0.22, 0.5)
    m["length"] = cw * rng.uniform(2.2, 3.1)
    m["hw"] = cw * rng.choice([rng.uniform(0.86, 1.04), rng.uniform(1.0, 1.3)],
                              p=[0.75, 0.25])
    m["nip"] = cw * max(0, rng.normal(0.02, 0.05))
    m["hem"] = rng.choice(["plain", "round", "tail"], p=[0.7, 0.25, 0.05])
    m["neck"] = "crew"
    if kind in ("tshirt", "longsleeve", "dress", "onepiece"):
        m["neck"] = rng.choice(["crew", "v", "boat", "scoop", "high"],
                               p=[0.5, 0.2, 0.12, 0.14, 0.04])
    if kind in ("shirt", "jacket"):
        m["hem"] = rng.choice(["plain", "tail"], p=[0.5, 0.5] if kind == "shirt" else [.9, .1])
    m["power"], m["depth"] = {
        "crew": (2.3, rng.uniform(0.5, 1.1)), "v": (1.05, rng.uniform(1.0, 2.0)),
        "boat": (2.0, rng.uniform(0.15, 0.4)), "scoop": (2.6, rng.uniform(1.2, 2.0)),
        "high": (2.2, rng.uniform(0.3, 0.5))}[m["neck"]]
    if m["neck"] in ("boat", "scoop"):
        m["nw"] *= rng.uniform(1.2, 1.6)
    m["nw"] = min(m["nw"], m["sw"] * 0.8)
    m["depth"] *= min(m["nw"], cw * 0.45)
    m["back"] = m["depth"] * rng.uniform(0.1, 0.35)
    m["behind"] = kind in ("tshirt", "longsleeve", "hoodie") and chance(rng, 0.1)
    if m["behind"]:
        m["depth"], m["back"] = m["back"], m["depth"]
    return m


def side_line(m):
    """The body's side edge as a function of y, on the right."""
    def edge(y):
        t = (np.asarray(y, float) - m["ad"]) / (m["length"] - m["ad"])
        tt = np.clip(t, 0, 1.4)
        return m["cw"] + (m["hw"] - m["cw"]) * tt ** m.get("flare", 1.0) \
            - m["nip"] * np.sin(np.pi * np.clip(t, 0, 1))
    return edge


def hem_line(m, n=29):
    """The lower edge from right to left."""
    x = np.linspace(1, -1, n)
    h, tail = m["hw"], m.get("tail", 0.12 * m["cw"])
    y = m["length"] + np.zeros(n)
    if m["hem"] == "round":
        y = y - tail * 0.8 * x ** 2
    if m["hem"] == "tail":
        y = y - tail * 2.2 * smooth((np.abs(x) - 0.55) / 0.45)
    if m.get("wave"):
        y = y + m["wave"] * np.sin(x * m["waves"] + m["phase"]) * (1 - x ** 8)
    return np.stack([x * h, y], 1).astype(np.float32)


def armhole(m, kind="set"):
    """The armhole from the shoulder point to the armpit, on the right."""
    s, a = (m["sw"], m["slope"]), (m["cw"], m["ad"])
    if kind == "bare":
        pull = (min(m["sw"], m["cw"]) - 0.05 * m["cw"], m["ad"] * 0.92)
        return bez(s, pull, a)
    if kind == "raglan":
        return bez((m["nw"] * 1.12, m["slope"] * 0.1), (m["sw"] * 0.72, m["ad"] * 0.62), a)
    return bez(s, (min(m["sw"], m["cw"]) - 0.1 * m["cw"], m["ad"] * 0.65), a)


def torso(m, kind="set"):
    """The front's outline, from the left neck point along the neckline."""
    neck = neckline(m["nw"], m["depth"], m["power"])
    hole = armhole(m, kind)
    edge = side_line(m)
    y = np.linspace(m["ad"], hem_line(m)[0, 1], 10)[1:-1]
    right = np.vstack([hole, np.stack([edge(y), y], 1)])
    return np.vstack([neck, right, hem_line(m), mirror(right)[::-1]]).astype(np.float32)


def top_marks(g, m):
    """The landmarks of neck, shoulders, armpits and hem."""
    hem = hem_line(m)
    for side, name in SIDES:
        f = np.array([side, 1], np.float32)
        g.marks["neck_" + name] = arr(m["nw"], 0) * f
        g.marks["shoulder_" + name] = arr(m["sw"], m["slope"]) * f
        g.marks["armpit_" + name] = arr(m["cw"], m["ad"]) * f
        g.marks["hem_" + name] = hem[0] * f
        g.pulls.append((side * m["cw"] * 0.95, m["ad"], -side * 0.7, 0.7))
    g.marks["neck_front"] = arr(0, m["depth"])


def sleeve_measures(rng, m, kind):
    """Length and width of a sleeve, and the kind of its seam."""
    w0 = np.hypot(m["cw"] - m["sw"], m["ad"] - m["slope"])
    short = kind in ("tshirt", "polo") or (kind in ("dress", "shirt", "onepiece")
                                           and chance(rng, 0.5))
    if short:
        length = m["cw"] * (rng.uniform(0.2, 0.45) if chance(rng, 0.2)
                            else rng.uniform(0.5, 0.95))
        width = w0 * rng.uniform(0.7, 1.0)
    else:
        length = m["cw"] * (rng.uniform(1.3, 1.7) if chance(rng, 0.15)
                            else rng.uniform(1.9, 2.5))
        width = w0 * rng.uniform(0.34, 0.62)
    seam = "raglan" if kind in ("tshirt", "longsleeve", "hoodie", "onepiece") \
        and chance(rng, 0.15) else "set"
    return dict(w0=w0, length=length, width=width, short=short, seam=seam,
                cuff=rng.uniform(2, 6) * m["cw"] / 26 if not short else rng.uniform(1, 3),
                rib=not short and chance(rng, 0.5))


def choose_lie(rng, short, hung):
    """How a sleeve lies: a word of LIES."""
    if short:
        return rng.choice(["apart", "over", "folded"], p=[0.95, 0.03, 0.02])
    if hung:
        return rng.choice(["apart", "beside", "over"], p=[0.45, 0.42, 0.13])
    return rng.choice(["apart", "beside", "over", "folded"], p=[0.47, 0.23, 0.25, 0.05])


def lay_sleeve(rng, m, q, lie, swing):
    """The strips of one sleeve on the right: [(strip, over the body?, has cuff?)]."""
    out, inn = (m["sw"], m["slope"]), (m["cw"], m["ad"])
    edge = side_line(m)
    if lie == "beside":
        gap0, gap1 = rng.uniform(-0.6, 0.5), rng.uniform(-0.8, 1.2) * m["cw"] / 26
        span = q["length"]

        def near(y):
            return edge(y) + gap0 + gap1 * np.clip((y - m["ad"]) / span, 0, 1)
        return [(hanging(out, inn, q["width"], q["length"], near,
                         share=rng.uniform(0.42, 0.72)), gap0 < 0 and chance(rng, .5), True)]
    if lie == "folded":
        part = dict(q, length=q["length"] * rng.uniform(0.12, 0.4))
        width = q["w0"] * 0.85
        return [(bent(out, inn, width, part["length"], rng.uniform(0.3, 1.2),
                      q["w0"] * 0.5), False, False)]
    natural = np.arctan2(m["cw"] * 0.5, q["length"]) + rng.uniform(0.1, 0.55)
    if q["short"]:
        natural = rng.uniform(0.45, 1.25)
    turn = natural + swing
    bow = rng.normal(0, 0.12)
    if lie == "apart":
        turn = np.clip(turn, 0.28, 1.7)
        elbow = (rng.uniform(0.35, 0.6), rng.normal(0, 0.25)) if not q["short"] else (.5, 0)
        elbow = (elbow[0], max(elbow[1], 0.14 - turn + 0.05))
        return [(bent(out, inn, q["width"], q["length"], turn, q["w0"] * rng.uniform(.4, .8),
                      bow=bow * 0.5, elbow=elbow), chance(rng, 0.3), True)]
    how = rng.choice(["down", "bend", "fold"], p=[0.35, 0.25, 0.4])
    if q["short"] or how == "down":
        return [(bent(out, inn, q["width"], q["length"], -rng.uniform(0.1, 0.5),
                      q["w0"] * rng.uniform(0.5, 0.9), bow=bow,
                      hug=rng.uniform(.4, .9)), True, True)]
    if how == "bend":
        return [(bent(out, inn, q["width"], q["length"], rng.uniform(-0.05, 0.3),
                      q["w0"] * 0.6, elbow=(rng.uniform(0.4, 0.55),
                                            -rng.uniform(0.6, 1.5)), n=22,
                      hug=rng.uniform(.4, .8)), True, True)]
    strip = bent(out, inn, q["width"], q["length"], rng.uniform(0.05, 0.55), q["w0"] * 0.6,
                 hug=rng.uniform(.2, .55))
    up, low = folded_on(strip, rng.uniform(0.35, 0.65), -rng.uniform(0.9, 2.6), q["width"])
    return [(up, chance(rng, 0.3), False), (low, True, True)]


def sleeve_details(rng, q, piece, strip, cuffed):
    """Lines at the cuff, seams and ribs of one sleeve piece."""
    if not cuffed:
        return
    tone = q["tone"]
    piece.lines.append((strip.across(q["cuff"]), tone, 0.25, False))
    if q["rib"]:
        end = strip.cut(max(0, len(strip.s) - 3), None)
        for v in np.linspace(0.08, 0.92, 8):
            piece.lines.append((end.along(v), 112, 0.3, False))


def add_sleeves(rng, g, m, q, hung=False, puff=False):
    """Both sleeves: pieces before the body, pieces after it, marks and lies."""
    before, after = [], []
    q["tone"] = rng.choice([90, 105, 112, 142])
    same = chance(rng, 0.65)
    first = choose_lie(rng, q["short"], hung)
    swing = rng.normal(0, 0.25)
    cloth = g.sleeve_cloth
    for side, name in SIDES:
        lie = first if same or side < 0 else choose_lie(rng, q["short"], hung)
        f = np.array([side, 1], np.float32)
        part = "sleeve_" + name
        strips = lay_sleeve(rng, m, q, lie, swing + rng.normal(0, 0.1))
        hole = armhole(m, q["seam"])
        cap = np.vstack([hole, arr((m["sw"], m["slope"]))]) if q["seam"] == "raglan" else hole
        for i, (strip, over, cuffed) in enumerate(strips):
            strip = strip.mirrored(side)
            piece = strip.piece(part, root=side * m["cw"], cloth=cloth,
                                lift=1.3 if over else 1.0)
            sleeve_details(rng, q, piece, strip, cuffed)
            if i == 0:
                piece.polys.append((cap * f).astype(np.float32))
                piece.flat.append((cap * f).astype(np.float32))
            (after if over else before).append(piece)
            if cuffed:
                g.marks["cuff_%s_outer" % name] = strip.outer[-1]
                g.marks["cuff_%s_inner" % name] = strip.inner[-1]
        if q["seam"] == "raglan" and strips[0][1] is False:
            after.append(Piece(part, [cap * f], [cap * f], cloth=cloth, join=True, lift=0.5))
        g.lies[part] = judged(lie, strips[-1][0].mirrored(side), m, side)
    return before, after


def judged(lie, strip, m, side):
    """The word for a sleeve as it came out, whatever it was meant to be."""
    if lie == "folded":
        return lie
    free = strip.s >= strip.s[0] + 0.3 * (strip.s[-1] - strip.s[0])
    gaps = []
    for edge in (strip.inner, strip.outer):
        x, y = edge[free, 0] * side, edge[free, 1]
        off = (y > m["length"]) | (y < m["slope"])
        gaps.append(np.where(off, 9.0, x - side_line(m)(y)) / (m["cw"] / 26))
    if np.mean(np.minimum(*gaps) < -2.0) > 0.3 and lie == "over":
        return "over"
    return "apart" if np.mean(np.minimum(*gaps) > 0.6) > 0.45 else "beside"


def hem_details(rng, m, body):
    """The stitched hem, side slits, and centre folds of a laid body."""
    up = rng.uniform(1.2, 3.5) * m["cw"] / 26
    hem = hem_line(m) - np.array([0, up], np.float32)
    body.lines.append((hem, rng.choice([100, 112, 148]), 0.22, chance(rng, 0.3)))
    if chance(rng, 0.15):
        x = rng.uniform(-0.2, 0.2) * m["cw"]
        body.lines.append((arr((x, m.get("depth", 0) + 2), (x, m["length"])), 112, 0.5, False))


def start(rng, kind):
    """An empty garment with the cloths of its pieces chosen."""
    g = Garment(kind)
    g.sleeve_cloth = "second" if chance(rng, 0.07) else "main"
    g.rib_cloth = "second" if chance(rng, 0.25) else "main"
    for limb in ("sleeve_left", "sleeve_right", "leg_left", "leg_right"):
        g.lies[limb] = "absent"
    return g


def button_line(rng, m, body, y0, y1, n):
    """A placket with buttons from y0 to y1."""
    k = m["cw"] / 26
    half = rng.uniform(1.2, 1.9) * k
    for x in (-half, half):
        body.lines.append((arr((x, y0), (x, y1)), 100 if x > 0 else 118, 0.25, False))
    tone = rng.choice([40, 90, 220])
    for y in np.linspace(y0 + 1.5 * k, y1 - 3 * k, n):
        body.dots.append((0, y, 0.6 * k, tone))


def gathers(rng, g, body, half, y, low, wide, n):
    """Soft folds that run down from a waist."""
    for t in rng.uniform(-0.9, 0.9, n):
        end = y + (low - y) * rng.uniform(0.3, 1.0)
        x1 = t * (half + (wide - half) * (end - y) / (low - y))
        body.lines.append((arr((t * half, y), (x1, end)), rng.choice([104, 116, 140]),
                           rng.uniform(0.4, 1.2), False))

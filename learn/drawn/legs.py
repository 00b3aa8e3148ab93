"""Skirts, trousers and shorts, from half the waist's width, in centimetres."""

import numpy as np

from .shapes import arr, bent, bez, folded_on, hanging, mirror, plate, smooth
from .basics import (SIDES, button_line, chance, gathers, hem_details, hem_line,
                     side_line, start)


def make_skirt(rng, kind, hung):
    """Skirts: a band and a straight, flared or pleated body."""
    g = start(rng, kind)
    ww = rng.uniform(18, 27) if chance(rng, 0.35) else rng.uniform(28, 44)
    ww /= 1.0 if chance(rng, 0.5) else 1.2
    length = ww * rng.uniform(1.1, 2.9)
    hw = ww * rng.choice([rng.uniform(0.9, 1.15), rng.uniform(1.2, 1.8),
                          rng.uniform(1.8, 2.6)], p=[0.35, 0.4, 0.25]) * 0.5 * 1.25
    ww /= 2
    m = dict(cw=ww, ad=0.0, hw=hw, length=length, nip=-ww * rng.uniform(0, 0.14),
             flare=rng.uniform(0.8, 1.3), hem=rng.choice(["plain", "round"], p=[0.4, 0.6]),
             tail=(hw - ww) * rng.uniform(0.3, 0.7) + 1)
    if chance(rng, 0.5):
        m.update(wave=rng.uniform(0.3, 1.6), waves=rng.uniform(8, 22), phase=rng.uniform(0, 6))
    edge, hem = side_line(m), hem_line(m)
    y = np.linspace(0, hem[0, 1], 10)
    right = np.stack([edge(y), y], 1)[:-1]
    dip = rng.uniform(-0.5, 2.0)
    waist = bez((-ww, 0), (0, dip * 2), (ww, 0))
    body = plate("body", np.vstack([waist, right, hem, mirror(right)[::-1]]))
    band = rng.uniform(2, 6) * ww / 16
    pieces = [band_behind(rng, ww, dip), body]
    if chance(rng, 0.85):
        pieces.append(waistband(rng, ww, edge(band), band, dip))
    hem_details(rng, m, body)
    style = rng.choice(["plain", "pleats", "gathers", "buttons"], p=[0.4, 0.2, 0.3, 0.1])
    if style == "pleats":
        for t in np.linspace(-0.93, 0.93, rng.integers(7, 20)):
            body.lines.append((arr((t * ww, band), (t * hw, length)), 88, 0.5, False))
    if style == "gathers":
        gathers(rng, g, body, ww, band, length, hw, 12)
    if style == "buttons":
        button_line(rng, dict(cw=26), body, band, length, 7)
    for side, name in SIDES:
        f = np.array([side, 1])
        g.marks["waist_" + name] = arr(ww, 0) * f
        g.marks["hem_" + name] = hem[0] * f
    g.pieces = pieces
    return g


def band_behind(rng, ww, dip):
    """The inner back of a waist, seen above the front edge."""
    rise = rng.uniform(0, 2.2)
    shape = np.vstack([bez((-ww, 0), (0, -rise), (ww, 0)),
                       bez((ww, 0.3), (0, dip * 2 + 1), (-ww, 0.3))])
    return plate("inside", shape, cloth="lining", dim=rng.uniform(0.6, 0.85))


def waistband(rng, ww, low, h, dip):
    """The front of a waistband, plain or gathered by elastic."""
    up = bez((-ww, 0), (0, dip * 2), (ww, 0))
    down = bez((low, h), (0, dip * 2 + h), (-low, h))
    p = plate("waistband", np.vstack([up, down]), join=True, lift=0.6,
              cloth="second" if chance(rng, 0.2) else "main")
    p.lines.append((down, 88, 0.35, False))
    if chance(rng, 0.5):
        for x in np.linspace(-0.95, 0.95, 24) * ww:
            p.lines.append((arr((x, dip + 0.3), (x * low / ww, h + dip * .6)),
                            rng.choice([105, 115, 145]), 0.35, False))
    return p


def leg_measures(rng, kind):
    """Random measures of trousers or shorts, from half the waist's width."""
    child = chance(rng, 0.35)
    ww = rng.uniform(11, 17) if child else rng.uniform(17, 26)
    rise = ww * rng.uniform(1.05, 1.6)
    hip = ww * rng.uniform(1.08, 1.35)
    m = dict(ww=ww, rise=rise, hip=hip, k=ww / 21, child=child)
    if kind == "shorts":
        m["length"] = ww * rng.choice([rng.uniform(0.12, 0.5), rng.uniform(0.5, 1.3)])
        m["hem"] = hip * (1 + rng.uniform(-.15, .2) * min(1, m["length"] / ww))
    else:
        m["length"] = ww * rng.uniform(2.9, 4.4) * (0.75 if chance(rng, 0.12) else 1)
        m["hem"] = hip * rng.choice([rng.uniform(0.38, 0.55), rng.uniform(0.5, 0.75),
                                     rng.uniform(0.8, 1.2)], p=[0.5, 0.35, 0.15])
    return m


def lay_leg(rng, m, lie, spread):
    """The strips of one leg on the right, without its upper part."""
    out, inn = (m["hip"], m["rise"] * 0.94), (0.0, m["rise"])
    bow = rng.normal(0, 0.05)
    if lie == "beside":
        g1 = rng.uniform(-0.3, 0.9) * m["k"]
        return [hanging(out, inn, m["hem"], m["length"],
                        lambda y: g1 * smooth((y - m["rise"]) / m["length"] * 2) + 0.1, share=1.0)]
    if lie == "over":
        return [bent(out, inn, m["hem"], m["length"], -rng.uniform(0.16, 0.5),
                     m["hip"] * 0.6, bow=bow)]
    if lie == "folded":
        strip = bent(out, inn, m["hem"], m["length"], spread, m["hip"] * 0.6, bow=bow)
        if chance(rng, 0.5) or m["length"] < m["hip"]:
            return [strip.cut(0, max(3, int(len(strip.s) * rng.uniform(0.35, 0.7))))]
        up, low = folded_on(strip, rng.uniform(0.4, 0.65), spread + np.pi
                            + rng.normal(0, 0.25), m["hem"])
        return [up, low]
    knee = (rng.uniform(0.35, 0.6), rng.normal(0, 0.2) if chance(rng, 0.35) else 0.0)
    return [bent(out, inn, m["hem"], m["length"], spread, m["hip"] * 0.7, bow=bow, elbow=knee)]


def pelvis(m, waist):
    """The upper part of trousers down to the line of the fork."""
    side = bez(waist[-1], (m["hip"] * 0.97, m["rise"] * 0.4), (m["hip"], m["rise"] * 0.94))
    return np.vstack([waist, side[1:], arr((0, m["rise"])), mirror(side)[::-1][:-1]])


def trouser_details(rng, m, body, style):
    """Fly, pockets and belt loops of jeans; seams of joggers and leggings."""
    k, ww, r = m["k"], m["ww"], m["rise"]
    dark = rng.choice([85, 100, 160])
    body.lines.append((bez((0, 3 * k), (0.4, r * 0.6), (0, r)), 92, 0.3, False))
    if style == "jeans":
        body.lines.append((bez((2.6 * k, 4 * k), (2.6 * k, r * 0.62), (0.3, r * 0.68)),
                           dark, 0.25, True))
        for s, _ in SIDES:
            f = np.array([s, 1])
            body.lines.append((bez((ww * 0.45, 3.6 * k), (ww * 0.55, r * 0.36),
                                   (m["hip"] * 0.95, r * 0.42)) * f, dark, 0.3, False))
        body.dots.append((0, 2 * k, 0.9 * k, rng.choice([60, 190])))
    elif style == "pocket":
        for s, _ in SIDES:
            body.lines.append((arr((ww * 0.7, 4 * k), (m["hip"] * 0.93, r * 0.55))
                               * np.array([s, 1]), 88, 0.35, False))
    elif style == "cord":
        for s, _ in SIDES:
            end = (s * rng.uniform(0.5, 4) * k, r * rng.uniform(0.35, 0.75))
            body.lines.append((bez((s * 0.6, 2 * k), (s * 2.5, r * 0.25), end),
                               rng.choice([30, 225]), 0.6, False))


def make_legs(rng, kind, hung):
    """Trousers and shorts."""
    g = start(rng, kind)
    m = leg_measures(rng, kind)
    dip = rng.uniform(-0.4, 1.6)
    ww = m["ww"]
    body = plate("body", pelvis(m, bez((-ww, 0), (0, dip * 2), (ww, 0))), join=True)
    style = rng.choice(["jeans", "pocket", "cord", "plain"], p=[0.45, 0.15, 0.2, 0.2])
    trouser_details(rng, m, body, style)
    legs, over = add_legs(rng, g, m, kind == "shorts")
    band = rng.uniform(2, 5) * m["k"]
    wb = waistband(rng, ww, ww + (m["hip"] - ww) * 0.15, band, dip)
    for side, name in SIDES:
        g.marks["waist_" + name] = arr(side * ww, 0)
        g.pulls.append((side * 1.0, m["rise"], side * 0.8, -0.3))
        g.pulls.append((side * 1.0, m["rise"], side * 0.5, 0.8))
    g.pieces = [band_behind(rng, ww, dip)] + legs + [body] + over + [wb]
    if style == "jeans":
        for x in (-0.75, -0.35, 0.35, 0.75):
            wb.lines.append((arr((x * ww, dip * .5), (x * ww, band + dip)), 100, 0.9, False))
    g.m = m
    return g


def add_legs(rng, g, m, short):
    """Both legs with their marks and lies; those over the other leg apart."""
    legs, over = [], []
    if short:
        base = rng.choice(["apart", "beside"], p=[0.6, 0.4])
    else:
        base = rng.choice(["apart", "beside", "over", "folded"], p=[0.58, 0.25, 0.1, 0.07])
    spread = abs(rng.normal(0, 0.1)) + (0.03 if not short else 0)
    if base == "apart":
        need = np.arctan2(m["hem"] - m["hip"], 2 * m["length"])
        spread = max(spread, need + rng.uniform(0.03, 0.2))
    if short:
        spread *= min(1, m["length"] / m["hip"])
    late = rng.integers(2)
    cuff = rng.uniform(1, 4) * m["k"]
    ribbed = not short and chance(rng, 0.2)
    crease, seam = chance(rng, 0.12), chance(rng, 0.35)
    inner = {}
    for i, (side, name) in enumerate(SIDES):
        lie = base
        if base in ("over", "folded") and i != late:
            lie = "apart"
        strips = lay_leg(rng, m, lie, spread + rng.normal(0, 0.02))
        for j, strip in enumerate(strips):
            strip = strip.mirrored(side)
            inner.setdefault(name, strip.inner)
            p = strip.piece("leg_" + name, root=side * m["hip"] / 2, join=j == 0)
            last = j == len(strips) - 1 and not (lie == "folded" and len(strips) == 1)
            if last:
                g.marks["leg_%s_outer" % name] = strip.outer[-1]
                g.marks["leg_%s_inner" % name] = strip.inner[-1]
                p.lines.append((strip.across(cuff), rng.choice([92, 150]), 0.25, False))
            for wanted, v in ((crease, 0.5), (seam, 0.12)):
                if wanted:
                    p.lines.append((strip.along(v), 108, 0.3, False))
            if ribbed and last:
                p.lines += [(strip.cut(-3, None).along(v), 112, 0.3, False)
                            for v in np.linspace(.1, .9, 7)]
            (over if lie == "over" or j else legs).append(p)
        g.lies["leg_" + name] = lie
    if base != "folded":
        n = min(len(inner["right"]), len(inner["left"]))
        gap = (inner["right"][:n, 0] - inner["left"][:n, 0])[3:] / m["k"]
        word = "apart" if np.mean(gap > 1.2) > 0.5 else "beside"
        if np.mean(gap < -1.5) > 0.3:
            word = "over"
        for i, limb in enumerate(("leg_left", "leg_right")):
            g.lies[limb] = "apart" if word == "over" and i != late else word
    g.marks["fork"] = arr(0, m["rise"])
    return legs, over

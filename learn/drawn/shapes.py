"""Shapes in centimetres: pieces, curves, necklines, and bent strips for limbs.

A piece is a list of polygons of one part. A limb is a strip: two edges of
equal count whose rows make four-cornered polygons, so that a bent or folded
limb carries its cloth along. All limbs are built on the picture's right side
and mirrored for the left.
"""

from dataclasses import dataclass, field

import numpy as np


@dataclass
class Piece:
    """Polygons of one part; flat holds where each corner lies on the cloth."""
    part: str
    polys: list
    flat: list
    lines: list = field(default_factory=list)   # (points, tone, width in cm, dashed)
    dots: list = field(default_factory=list)    # (x, y, radius in cm, tone)
    cloth: str = "main"
    dim: float = 1.0
    join: bool = False      # no edge towards what lies below in the garment
    lift: float = 1.0       # thickness: strength of edge and shadow


@dataclass
class Garment:
    """Pieces in drawing order with the truth about them."""
    kind: str
    pieces: list = field(default_factory=list)
    marks: dict = field(default_factory=dict)
    lies: dict = field(default_factory=dict)
    pulls: list = field(default_factory=list)   # (x, y, dx, dy): folds start here
    print_box: tuple = None
    hanger: bool = False
    flat: bool = True


def arr(*points):
    return np.array(points, np.float32)


def bez(p0, c, p1, n=9):
    """A quadratic curve from p0 to p1 with control point c."""
    t = np.linspace(0, 1, n, dtype=np.float32)[:, None]
    p0, c, p1 = (np.asarray(p, np.float32) for p in (p0, c, p1))
    return (1 - t) ** 2 * p0 + 2 * t * (1 - t) * c + t * t * p1


def mirror(points):
    return np.asarray(points, np.float32) * np.array([-1, 1], np.float32)


def both(points):
    """A half outline on the right, closed by its mirror image on the left."""
    p = np.asarray(points, np.float32)
    return np.vstack([p, mirror(p)[::-1]])


def neckline(half, depth, power, n=17):
    """Points of a neckline from the left to the right neck point."""
    t = np.sin(np.linspace(-np.pi / 2, np.pi / 2, n))
    y = depth * (1 - np.abs(t) ** power)
    return np.stack([t * half, y], 1).astype(np.float32)


def smooth(t):
    t = np.clip(t, 0, 1)
    return t * t * (3 - 2 * t)


def plate(part, outline, **more):
    """A piece of one polygon, flat as it lies."""
    p = np.asarray(outline, np.float32)
    return Piece(part, [p], [p], **more)


@dataclass
class Strip:
    """A limb: outer and inner edge, and the length along it at each row."""
    outer: np.ndarray
    inner: np.ndarray
    s: np.ndarray

    def mirrored(self, side):
        if side > 0:
            return self
        return Strip(mirror(self.outer), mirror(self.inner), self.s)

    def piece(self, part, root=0.0, **more):
        """The strip as a piece; on the cloth it runs straight down."""
        polys, flat = [], []
        w = np.linalg.norm(self.outer - self.inner, axis=1)
        for i in range(len(self.s) - 1):
            polys.append(np.stack([self.outer[i], self.outer[i + 1],
                                   self.inner[i + 1], self.inner[i]]))
            a, b, y0, y1 = w[i] / 2, w[i + 1] / 2, self.s[i], self.s[i + 1]
            flat.append(arr((a, y0), (b, y1), (-b, y1), (-a, y0))
                        + np.array([root, 0], np.float32))
        return Piece(part, polys, flat, **more)

    def across(self, back):
        """The line across the strip at a distance back from its end."""
        i = int(np.argmin(np.abs(self.s - (self.s[-1] - back))))
        return np.stack([self.outer[i], self.inner[i]])

    def along(self, v):
        """The line along the strip at share v from the outer to the inner edge."""
        return self.outer * (1 - v) + self.inner * v

    def cut(self, start, stop):
        return Strip(self.outer[start:stop], self.inner[start:stop], self.s[start:stop])


def bent(root_out, root_in, width, length, turn, blend, n=16, bow=0.0,
         elbow=(0.5, 0.0), hug=0.0):
    """A strip that leaves its root and turns to the angle turn (0 = down).

    hug moves it inwards, so that its outer edge stays near the root's end."""
    root_out, root_in = np.asarray(root_out, float), np.asarray(root_in, float)
    mid, r = (root_out + root_in) / 2, root_out - root_in
    w0 = np.hypot(*r) + 1e-6
    start = turn + 0.3 * (np.arctan2(-r[1], r[0]) - turn)
    s = np.linspace(0, length, n)
    b = smooth(s / max(blend, 1e-3))
    th = start + (turn - start) * b + bow * (s / length) \
        + elbow[1] * smooth((s / length - elbow[0]) * 6 + 0.5)
    d = np.stack([np.sin(th), np.cos(th)], 1)
    p = mid + np.vstack([[0, 0], np.cumsum((d[1:] + d[:-1]) / 2
                                           * np.diff(s)[:, None], 0)])
    w = w0 + (width - w0) * (s / length) ** 0.8
    nrm = np.stack([np.cos(th), -np.sin(th)], 1) * (w / 2)[:, None]
    p = p - nrm * (hug * b)[:, None]
    off = (r / 2) * (1 - b)[:, None] + nrm * b[:, None]
    return Strip((p + off).astype(np.float32), (p - off).astype(np.float32),
                 s.astype(np.float32))


def hanging(root_out, root_in, width, length, edge, n=14, share=0.93):
    """A strip straight down whose inner edge follows x = edge(y)."""
    so, a = np.asarray(root_out, float), np.asarray(root_in, float)
    w0 = np.hypot(*(so - a)) * share
    k = 5
    y = np.linspace(a[1], max(so[1] + length, a[1] + 4), n)
    t = (y - y[0]) / (y[-1] - y[0])
    xin = edge(y)
    xin = xin + (a[0] - xin[0]) * np.exp(-t * 8)
    w = w0 + (width - w0) * t ** 0.8
    inner = np.stack([xin, y], 1)
    outer = np.stack([xin + w, y], 1)
    corner = so + (outer[0] - so) * np.array([0.62, 0.36])
    top = bez(so, corner, outer[0], k)[:-1]
    side = so + (a - so) * np.linspace(0, 1, k)[:-1, None]
    outer, inner = np.vstack([top, outer]), np.vstack([side, inner])
    mid = (outer + inner) / 2
    s = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(mid, axis=0).T))])
    return Strip(outer.astype(np.float32), inner.astype(np.float32),
                 s.astype(np.float32))


def folded_on(strip, at, turn, width, n=9):
    """A strip folded sharply at row share at: the upper and the lower strip."""
    i = max(2, int(at * (len(strip.s) - 1)))
    o, q = strip.outer[i].astype(float), strip.inner[i].astype(float)
    p, nrm = (o + q) / 2, (o - q)
    w = np.hypot(*nrm)
    nrm /= w + 1e-6
    d1 = np.array([-nrm[1], nrm[0]])
    d2 = np.array([np.sin(turn), np.cos(turn)])
    c = d1 + d2
    c = np.array(nrm) if np.hypot(*c) < 0.3 else c / np.hypot(*c)
    lean = float(c @ nrm)
    t = np.clip((c @ d1) / (lean if abs(lean) > 0.3 else 0.3 * (np.sign(lean) or 1)),
                -1, 1) * w / 2
    co, ci = p + nrm * w / 2 + d1 * t, p - nrm * w / 2 - d1 * t
    n2 = 2 * (nrm @ c) * c - nrm
    rest = max(strip.s[-1] - strip.s[i], w * 0.8)
    s = np.linspace(min(w * 0.55, rest * 0.5), rest, n)
    ww = (w + (width - w) * (s / rest))[:, None] / 2
    lower_o = np.vstack([co, p + d2 * s[:, None] + n2 * ww])
    lower_i = np.vstack([ci, p + d2 * s[:, None] - n2 * ww])
    up = Strip(np.vstack([strip.outer[:i], co]).astype(np.float32),
               np.vstack([strip.inner[:i], ci]).astype(np.float32), strip.s[:i + 1])
    low = Strip(lower_o.astype(np.float32), lower_i.astype(np.float32),
                (strip.s[i] + np.concatenate([[0], s])).astype(np.float32))
    return up, low

"""The scene: garment, ground, light and camera joined into one photo.

Method: every polygon gets a number and an affine map from picture to cloth;
number image and maps are filled in drawing order, one remap then brings cloth
and creases. Edges and shadows come from blurred masks piece by piece, seams
from a separate grey layer that later pieces cover. Drawn at 1.5 times the
size and shrunk at the end.
"""

import cv2
import numpy as np

from . import banks, cloth, grounds
from words import LANDMARKS, PARTS

ASPECTS = ((3, 4), (4, 3), (1, 1), (9, 16), (16, 9))
ASPECT_ODDS = (.6, .17, .1, .1, .03)
BIT = 4
HANGER = PARTS.index("hanger")


def frame_size(rng, size):
    """Width and height of the photo within a square of the given size."""
    a, b = ASPECTS[rng.choice(5, p=ASPECT_ODDS)]
    return int(size * a / max(a, b)), int(size * b / max(a, b))


class Camera:
    """Centimetres to pixels: smooth warp of the cloth, turn, tilt and scale."""

    def __init__(self, rng, g, w, h):
        pts = np.vstack([q for p in g.pieces for q in p.polys])
        self.mid = (pts.min(0) + pts.max(0)) / 2
        self.size = float((pts.max(0) - pts.min(0)).max())
        self.bend = rng.normal(0, .012, (4, 2)) * self.size * (.5 if g.hanger else 1)
        self.wave = rng.uniform(1.5, 6, (4, 2)) / self.size * np.array([[1], [1.6], [2.8], [7]])
        self.bend *= np.array([[1.0], [.6], [.25], [.12]])
        self.phase = rng.uniform(0, 6.28, (4, 2))
        turn = np.clip(rng.normal(0, .11), -.26, .26) * (.35 if g.hanger else 1)
        if rng.random() < .05 and not g.hanger:
            turn += rng.choice([np.pi / 2, np.pi, -np.pi / 2])
        self.c, self.s = np.cos(turn), np.sin(turn)
        tilt = np.abs(rng.normal(0, .14)) if rng.random() < .8 else rng.uniform(0, .42)
        self.tilt = np.clip(tilt, 0, .42) * rng.choice([-1, 1], p=[.2, .8])
        self.side = rng.normal(0, .05)
        self.scale, self.shift = 1.0, np.zeros(2)
        self.fit(rng, self.project(pts), w, h)

    def project(self, p):
        """Points in the unscaled picture."""
        q = np.asarray(p, np.float32) - self.mid
        for b, k, f in zip(self.bend, self.wave, self.phase):
            q = q + b * np.sin(q[:, ::-1] * k + f)
        q = np.stack([self.c * q[:, 0] - self.s * q[:, 1],
                      self.s * q[:, 0] + self.c * q[:, 1]], 1)
        d = 1 - (np.sin(self.tilt) * q[:, 1] + self.side * q[:, 0]) / (self.size * 1.9)
        q[:, 1] *= np.cos(self.tilt)
        return q / d[:, None]

    def fit(self, rng, pts, w, h):
        """The scale and the shift that put the garment into the frame."""
        lo, hi = pts.min(0), pts.max(0)
        most = min(w / (hi[0] - lo[0]), h / (hi[1] - lo[1]))
        cut = rng.random() < .12
        share = rng.uniform(1.0, 1.35) if cut else rng.choice(
            [rng.uniform(.83, 1.0), rng.uniform(.45, .88)], p=[.8, .2])
        self.scale = most * share
        slack = np.array([w, h]) - (hi - lo) * self.scale
        place = rng.uniform(0, 1, 2) if cut else rng.beta(2.5, 2.5, 2)
        self.shift = slack * place - lo * self.scale

    def __call__(self, p):
        return (self.project(p) * self.scale + self.shift).astype(np.float32)


def three(x):
    """A grey layer as three equal channels: faster than broadcasting."""
    return cv2.merge([x, x, x])


def fixed(p):
    return np.round(p * (1 << BIT)).astype(np.int32)


def fill(img, poly, value):
    """A polygon filled at sub-pixel places."""
    if len(poly) == 4:
        cv2.fillConvexPoly(img, fixed(poly), value, cv2.LINE_8, BIT)
    else:
        cv2.fillPoly(img, [fixed(poly)], value, cv2.LINE_8, BIT)


def to_cloth(flat, px):
    """The affine map from picture to cloth that fits a polygon's corners."""
    a = np.hstack([px, np.ones((len(px), 1))])
    n = a.T @ a
    n[0, 0] += .05
    n[1, 1] += .05
    return np.linalg.solve(n, a.T @ flat).T


class Layers:
    """The picture's layers while pieces are laid one on another."""

    def __init__(self, rng, w, h, cam):
        self.w, self.h, self.cam, self.rng = w, h, cam, rng
        self.number = np.zeros((h, w), np.uint8)
        self.ink = np.full((h, w), 128, np.uint8)
        self.shade = np.ones((h, w), np.float32)
        self.any = np.zeros((h, w), np.uint8)
        self.base = np.zeros((h, w), np.uint8)      # bodies that legs grow from
        self.limbs = np.zeros((h, w), np.uint8)     # the legs that grow from them
        self.rows = [(0, 0, 0, 0, 0, 0)]
        self.piece_of = [0]
        self.pieces = [None]
        a = rng.uniform(0, 2 * np.pi)
        self.light = np.array([np.cos(a), np.sin(a)]) * rng.uniform(.3, 1.0)
        self.edge = rng.uniform(.04, .28)
        self.seam = rng.uniform(.3, 1.0)
        self.contact = rng.uniform(.25, .8)

    def window(self, px):
        """The part of the picture that a piece and its shadow reach."""
        pad = int(self.cam.scale * 2.5) + 6
        x0, y0 = np.maximum(np.floor(px.min(0)).astype(int) - pad, 0)
        x1, y1 = np.ceil(px.max(0)).astype(int) + pad
        return slice(y0, min(y1, self.h)), slice(x0, min(x1, self.w))

    def mark_joins(self, pieces):
        """The places of joined bodies and legs, between which no edge shows."""
        for p in pieces:
            if p.join and p.part[:3] in ("bod", "leg"):
                target = self.base if p.part == "body" else self.limbs
                for poly in p.polys:
                    fill(target, self.cam(poly), 255)

    def lay(self, piece):
        """One piece over all that lies already."""
        corners = self.cam(np.vstack(piece.polys))
        polys = np.split(corners, np.cumsum([len(q) for q in piece.polys])[:-1])
        win = self.window(corners)
        if win[0].stop <= win[0].start or win[1].stop <= win[1].start:
            return
        k = len(self.pieces)
        self.pieces.append(piece)
        mask = np.zeros((self.h, self.w), np.uint8)
        for poly, flat in zip(polys, piece.flat):
            n = len(self.rows)
            if n > 250:
                break
            fill(self.number, poly, n)
            fill(mask, poly, 255)
            self.rows.append(tuple(to_cloth(flat, poly).ravel()))
            self.piece_of.append(k)
        m = mask[win]
        self.light_edges(piece, m, win)
        self.ink[win][m > 0] = 128
        self.draw_lines(piece)
        np.maximum(self.any[win], m, out=self.any[win])

    def light_edges(self, piece, m, win):
        """Shadow beside a piece and the roundness of its own rim."""
        leg = piece.join and piece.part[:3] == "leg"
        solid = m
        if piece.join:
            solid = np.maximum(m, (self.base if leg else self.any)[win])
            if not leg:
                solid = np.maximum(solid, self.limbs[win])
        soft = max(1.2, self.cam.scale * .55 * piece.lift)
        k = int(soft) * 2 + 1
        b = cv2.blur(cv2.blur(solid, (k, k)), (k, k)).astype(np.float32) * (1 / 255)
        gx = cv2.Sobel(b, cv2.CV_32F, 1, 0) * (soft * .5)
        gy = cv2.Sobel(b, cv2.CV_32F, 0, 1) * (soft * .5)
        slope = gx * self.light[0] + gy * self.light[1]
        own = 1 - self.edge * piece.lift * (1 - b) * 1.2 + slope * .35 * piece.lift
        dark = 1
        if leg or not piece.join:
            dark = 1 - self.contact * min(piece.lift, 1.2) * np.clip(b - slope * .7, 0, .6)
            if leg:
                dark = np.where(self.base[win] > 0, 1, dark)
        old = self.shade[win]
        self.shade[win] = np.where(m > 0, own, old * dark)

    def draw_lines(self, piece):
        """Seams, stitches, buttons and ribs of a piece."""
        if not piece.lines and not piece.dots:
            return
        every = fixed(self.cam(np.vstack([l[0] for l in piece.lines]
                                         + [np.array(piece.dots)[:, :2].reshape(-1, 2)]
                                         if piece.dots else [l[0] for l in piece.lines])))
        at = 0
        for pts, tone, width, dashed in piece.lines:
            px, at = every[at:at + len(pts)], at + len(pts)
            t = max(1, int(round(width * self.cam.scale)))
            tone = int(128 + (int(tone) - 128) * (self.seam if 80 < tone < 160 else 1))
            if width * self.cam.scale < .7:
                tone = int(128 + (tone - 128) * max(.35, width * self.cam.scale / .8))
            if dashed and len(px) > 3:
                for i in range(0, len(px) - 1, 2):
                    cv2.polylines(self.ink, [px[i:i + 2]], False, tone, t, cv2.LINE_AA, BIT)
            else:
                cv2.polylines(self.ink, [px], False, tone, t, cv2.LINE_AA, BIT)
        for (_, _, r, tone), c in zip(piece.dots, every[at:]):
            cv2.circle(self.ink, tuple(map(int, c)), int(max(.8, r * self.cam.scale) * 16),
                       int(tone), -1, cv2.LINE_AA, BIT)


def pull_folds(rng, g, layers):
    """Folds that run from armpits and fork, as a change of shade."""
    h, w, cam = layers.h, layers.w, layers.cam
    canvas = np.zeros((h // 2 + 1, w // 2 + 1), np.float32)
    unit = cam.size
    for x, y, dx, dy in g.pulls:
        for _ in range(int(rng.integers(0, 4))):
            a = rng.normal(0, .5)
            c, s = np.cos(a), np.sin(a)
            v = np.array([c * dx - s * dy, s * dx + c * dy]) * unit * rng.uniform(.06, .28)
            p0 = np.array([x, y]) + rng.normal(0, .012, 2) * unit
            p = cam(np.array([p0, p0 + v * .5 + rng.normal(0, .012, 2) * unit, p0 + v])) / 2
            cv2.polylines(canvas, [fixed(p)], False, float(rng.choice([-1, 1])),
                          int(rng.integers(1, 3)), cv2.LINE_AA, BIT)
    soft = cv2.GaussianBlur(canvas, (0, 0), max(1.0, cam.scale * unit * .006))
    d = cv2.Sobel(soft, cv2.CV_32F, 1, 0) * layers.light[0] \
        + cv2.Sobel(soft, cv2.CV_32F, 0, 1) * layers.light[1]
    return cv2.resize(d, (w, h), interpolation=cv2.INTER_LINEAR) * rng.uniform(.05, .35)


def creases(rng, u, v, scale):
    """The shade of creases at cloth places u, v (cm)."""
    total = 0
    rough = rng.choice([.4, .9, 1.7], p=[.3, .5, .2])
    for bank, low, high, amount in ((banks.BROAD, 1.2, 4, .06), (banks.CREASE, 2, 5, .035),
                                    (banks.CREASE, 4, 9, .018)):
        f = bank[rng.integers(len(bank))]
        per = rng.uniform(low, high) * scale
        a = rng.uniform(0, 2 * np.pi)
        c, s = np.float32(np.cos(a) * per), np.float32(np.sin(a) * per)
        x0, y0 = np.float32(rng.uniform(0, 512)), np.float32(rng.uniform(0, 512))
        field = cv2.remap(f, u * c - v * s + x0, u * s + v * c + y0, cv2.INTER_LINEAR,
                          borderMode=cv2.BORDER_WRAP)
        total = total + field * (amount * rough * rng.uniform(.3, 1.3))
    return total


def piece_colours(rng, main, pieces):
    """For each cloth name a plain colour, or None for the main texture."""
    second = cloth.colour(rng)
    lining = None if rng.random() < .65 else cloth.colour(rng)
    collar = None if rng.random() < .75 else (second if rng.random() < .7 else cloth.colour(rng))
    return dict(main=None, second=second, lining=lining, collar=collar,
                metal=np.array([165, 165, 168], np.float32),
                dark=np.array([35, 32, 32], np.float32) if rng.random() < .6
                else cloth.colour(rng),
                paper=np.array([235, 232, 222], np.float32))


def cover(rng, g, L):
    """Colour and shade of the garment, without light of the room."""
    rows = np.array(L.rows, np.float32)
    piece_of = np.array(L.piece_of)
    xx = np.arange(L.w, dtype=np.float32)[None]
    yy = np.arange(L.h, dtype=np.float32)[:, None]
    r = [np.take(rows[:, i].copy(), L.number) for i in range(6)]
    u = r[0] * xx + r[1] * yy + r[2]
    v = r[3] * xx + r[4] * yy + r[5]
    wob = rng.uniform(.1, .5) * L.cam.size / 70
    wobble = banks.sample(banks.CLOUD[0], rng, L.w, L.h, rng.uniform(.8, 1.8)) * np.float32(wob)
    u += wobble
    v += wobble[::-1, ::-1]
    tex, per, mean = cloth.texture(rng, g.kind)
    per *= 60 / max(L.cam.size, 35)
    alb = cv2.remap(tex, u * np.float32(per), v * np.float32(per), cv2.INTER_LINEAR,
                    borderMode=cv2.BORDER_WRAP).astype(np.float32)
    alb = lay_print(rng, g, L, alb, u, v)
    table = piece_colours(rng, mean, L.pieces)
    which = piece_of[L.number].astype(np.uint8)
    dim = np.ones(len(L.pieces), np.float32)
    for k, p in enumerate(L.pieces[1:], 1):
        joined = p.join or p.part == "body"
        dim[k] = p.dim * (1 if joined else 1 + rng.normal(0, .025))
        if table[p.cloth] is not None:
            alb[which == k] = table[p.cloth]
    fold = creases(rng, u, v, 60 / max(L.cam.size, 30)) + pull_folds(rng, g, L)
    part = np.array([0] + [PARTS.index(p.part) for p in L.pieces[1:]], np.uint8)[which]
    fold[part == HANGER] *= .2
    ink = L.ink.astype(np.float32) * (1 / 128)
    shade = np.clip(L.shade * (1 + fold), .25, 1.6) * dim[which]
    lift = (ink - 1) * 24
    gloss = np.float32(rng.uniform(0, 56)) * np.maximum(fold, 0)
    factor = (np.clip(ink, 0, 1.5) * shade).astype(np.float32)
    offset = (np.maximum(lift, -6) * shade + gloss).astype(np.float32)
    return cv2.add(cv2.multiply(alb, three(factor)), three(offset)), part, mean


def lay_print(rng, g, L, alb, u, v):
    """A print on the chest, for the kinds that have one."""
    if g.print_box is None or rng.random() > .5:
        return alb
    x, y, half = g.print_box
    if rng.random() < .25:
        x, half = x + rng.choice([-.8, .8]) * half, half * .3
    img = cloth.print_image(rng)
    s = np.float32(64 / half)
    tall = np.float32(rng.uniform(.7, 1.2))
    layer = cv2.remap(img, (u - np.float32(x)) * s + 64, (v - np.float32(y)) * s * tall + 40,
                      cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT)
    body = [k for k, p in enumerate(L.pieces) if p is not None and p.part == "body"]
    on = np.isin(np.array(L.piece_of), body[:1])[L.number]
    a = three(layer[..., 3] * on)
    return alb * (1 - a) + layer[..., :3] * a


def ground_shadow(rng, any_mask, scale, hung):
    """The shadow of the garment on the ground: a dark rim and a wide soft one."""
    k = max(3, int(scale * rng.uniform(.6, 1.6)) * 2 + 1)
    near = cv2.blur(any_mask, (k, k))
    big = max(5, int(scale * rng.uniform(2, 5)) * 2 + 1)
    off = rng.normal(0, 1, 2) * scale * (2.5 if hung else .8)
    m = np.array([[1, 0, off[0]], [0, 1, off[1]]])
    far = cv2.blur(cv2.warpAffine(any_mask, m, any_mask.shape[::-1]), (big, big))
    a, b = rng.uniform(.05, .5), rng.uniform(0, .3)
    return 1 - near.astype(np.float32) * np.float32(a / 255) \
        - far.astype(np.float32) * np.float32(b / 255)


def rim_things(rng, img, w, h):
    """Feet, furniture legs, or another thing at the photo's rim."""
    for _ in range(int(rng.integers(1, 3))):
        c = rng.choice(["foot", "leg", "cloth"])
        side = rng.integers(4)
        t = rng.uniform(.05, .95)
        p = [(t * w, h), (t * w, 0), (0, t * h), (w, t * h)][side]
        k = tuple(map(float, cloth.colour(rng)))
        if c == "foot":
            skin = k if rng.random() < .5 else (205., 160., 135.)
            for d in (-.08, .08):
                q = (int(p[0] + d * w), int(p[1]))
                cv2.ellipse(img, q, (int(w * .05), int(h * .09)), 0, 0, 360, skin, -1, cv2.LINE_AA)
        elif c == "leg":
            q = (int(p[0] + rng.normal(0, .05) * w), int(p[1] + rng.normal(0, .05) * h))
            cv2.line(img, (int(p[0]), int(p[1])), q, k, int(w * rng.uniform(.03, .12)), cv2.LINE_AA)
        else:
            n = 9
            a = np.linspace(0, 6.28, n)
            r = rng.uniform(.04, .16, n) * max(w, h)
            q = np.stack([p[0] + r * np.cos(a), p[1] + r * np.sin(a)], 1).astype(np.int32)
            cv2.fillPoly(img, [q], k, cv2.LINE_AA)


def room_light(rng, w, h):
    """A factor for the whole photo: gradient, vignette, hard or soft shadows."""
    x = np.linspace(-.5, .5, w, dtype=np.float32)[None]
    y = np.linspace(-.5, .5, h, dtype=np.float32)[:, None]
    a = rng.uniform(0, 6.28)
    g = 1 + (x * np.float32(np.cos(a)) + y * np.float32(np.sin(a))) * np.float32(rng.normal(0, .22))
    g -= (x * x + y * y) * np.float32(rng.uniform(0, .45))
    if rng.random() < .15:
        m = np.zeros((h, w), np.float32)
        if rng.random() < .5:
            c, n = (rng.uniform(0, w), h * rng.uniform(.85, 1.1)), 12
            t = np.linspace(0, 6.28, n)
            q = np.stack([c[0] + w * rng.uniform(.15, .3) * np.cos(t),
                          c[1] + h * rng.uniform(.2, .5) * np.sin(t)], 1)
        else:
            c, d, a = rng.uniform(0, 1, 2) * (w, h), rng.uniform(.1, .6) * w, rng.uniform(0, 6.28)
            v, n = np.array([np.cos(a), np.sin(a)]), np.array([-np.sin(a), np.cos(a)])
            q = np.array([c + v * 999, c - v * 999, c - v * 999 + n * d, c + v * 999 + n * d])
        cv2.fillPoly(m, [q.astype(np.int32)], 1.0)
        k = int(rng.choice([3, 9, 31]))
        g *= 1 - cv2.blur(m, (k, k)) * np.float32(rng.uniform(.1, .45))
    return g


def develop(rng, img, size):
    """The photo as a phone stores it: balance, exposure, blur, noise, JPEG."""
    gain = rng.lognormal(.02, .14) * rng.normal(1, .045, 3)
    mean = float(img[::7, ::7].mean())
    gain *= min(1.0, rng.uniform(165, 215) / (mean + 1))
    x = np.arange(256)[:, None] * gain + rng.uniform(-4, 16)
    x = 255 * np.clip(x / 255, 0, 1.15) ** rng.uniform(.8, 1.25)
    table = np.clip((x - mean) * rng.uniform(.8, 1.15) + mean, 0, 255).astype(np.uint8)
    img = cv2.LUT(np.clip(img, 0, 255).astype(np.uint8), table.reshape(1, 256, 3))
    s = abs(rng.normal(0, .55))
    if s > .3:
        img = cv2.GaussianBlur(img, (0, 0), s)
    h, w = img.shape[:2]
    k = size / max(h, w)
    img = cv2.resize(img, (int(round(w * k)), int(round(h * k))), interpolation=cv2.INTER_AREA)
    h, w = img.shape[:2]
    x, y = rng.integers(0, max(1, 2 * banks.N - max(w, h)), 2)
    noise = banks.NOISE[y:y + h, x:x + w]
    noise = three(noise[:, :, 0]) if rng.random() < .7 else noise
    amount = np.float32(min(6, .3 + rng.exponential(1.3)))
    img = np.clip(img + noise * amount, 0, 255).astype(np.uint8)
    q = int(rng.integers(50, 96))
    code = cv2.imencode(".jpg", img[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, q])[1]
    return cv2.imdecode(code, cv2.IMREAD_COLOR)[:, :, ::-1]


def marks_of(g, cam, w, h):
    """Landmarks in the photo's pixels, and whether the garment is uncut."""
    out = np.zeros((len(LANDMARKS), 3), np.float32)
    for name, p in g.marks.items():
        x, y = cam(np.asarray(p, np.float32)[None])[0]
        if 0 <= x < w and 0 <= y < h:
            out[LANDMARKS.index(name)] = x, y, 1
    pts = cam(np.vstack([q for p in g.pieces if p.part != "hanger" for q in p.polys]))
    inside = (pts >= -1).all() and (pts[:, 0] <= w).all() and (pts[:, 1] <= h).all()
    return out, bool(inside)


def other_side(word):
    """A word for the left changed to the right, and back."""
    if "left" in word:
        return word.replace("left", "right")
    return word.replace("right", "left")


def swap_sides(g):
    """The garment's words changed for one that lies upside down."""
    for p in g.pieces:
        p.part = other_side(p.part)
    g.marks = {other_side(k): v for k, v in g.marks.items()}
    g.lies = {other_side(k): v for k, v in g.lies.items()}


def photo(rng, g, size):
    """The photo of a garment: image, parts, landmarks (all w by h), whole."""
    w, h = frame_size(rng, size * 3 // 2)
    cam = Camera(rng, g, w, h)
    if cam.c < -.5:
        swap_sides(g)
    L = Layers(rng, w, h, cam)
    L.mark_joins(g.pieces)
    for p in g.pieces:
        L.lay(p)
    img, part, mean = cover(rng, g, L)
    ground = grounds.ground(rng, w, h, cam.tilt * .8, g.hanger,
                            mean if rng.random() < .08 else None)
    if rng.random() < .13:
        rim_things(rng, ground, w, h)
    ground = cv2.multiply(ground, three(ground_shadow(rng, L.any, cam.scale, g.hanger)))
    cv2.copyTo(img, L.number, ground)
    img = cv2.multiply(ground, three(room_light(rng, w, h).astype(np.float32)))
    img = develop(rng, img, size)
    marks, whole = marks_of(g, cam, w, h)
    k = img.shape[1] / w
    marks[:, 0] = (marks[:, 0] + .5) * k - .5
    marks[:, 1] = (marks[:, 1] + .5) * img.shape[0] / h - .5
    marks[marks[:, 2] == 0] = 0
    part = cv2.resize(part, (img.shape[1], img.shape[0]), interpolation=cv2.INTER_NEAREST)
    return img, part, marks, whole

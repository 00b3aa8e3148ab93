"""The pictures to learn from: drawn ones with exact truth, real ones with kinds only.

What: `split` keeps senders apart; `Real` holds the real photos, `Drawn` the drawn
    ones (new folders are picked up by `grow`); `views` turns some of them into an
    augmented batch with its truth. All pictures wait in memory as SIDE x SIDE
    squares, letterboxed with black. Unknown truth is 255 in part maps and -1
    elsewhere, and the losses pass over it.
Source: photos of the clothing-dataset (CC0); affine, colour and light changes
    after common practice; grounds of real photos behind drawn garments after
    Dwibedi et al. 2017 (cut, paste and learn).
Cost: about 150 KB of memory per picture; 2 ms of one core per picture and batch.
"""
import csv
import glob
import hashlib
import json
import os

import cv2
import numpy as np
import torch
import torch.nn.functional as F

from words import KINDS, LANDMARKS, PARTS

SIDE = 192
SEED = 20261129
UNKNOWN = 255
DATA = os.environ.get("GARMENTS", "data")
WORK = os.environ.get("TRAIN", os.path.join("out", "learn"))
NAMES = {"T-Shirt": "tshirt", "Polo": "polo", "Longsleeve": "longsleeve", "Shirt": "shirt", "Blouse": "shirt",
         "Undershirt": "sleeveless", "Top": "sleeveless", "Dress": "dress", "Skirt": "skirt",
         "Pants": "trousers", "Shorts": "shorts", "Outwear": "jacket", "Blazer": "jacket",
         "Hoodie": "hoodie", "Body": "onepiece"}


def mirrored(words):
    """Index of each word's other side."""
    swap = {"left": "right", "right": "left"}
    other = ["_".join(swap.get(w, w) for w in word.split("_")) for word in words]
    return [words.index(o) for o in other]


MIRROR_PARTS = torch.tensor(mirrored(PARTS) + list(range(len(PARTS), 256)), dtype=torch.uint8)
MIRROR_MARKS = torch.tensor(mirrored(LANDMARKS))
MIRROR_LIMBS = torch.tensor([1, 0, 3, 2])


def letterbox(picture, side=SIDE):
    """The picture in a black square, and its box there (x0, y0, x1, y1, all 0..1)."""
    h, w = picture.shape[:2]
    f = side / max(h, w)
    w2, h2 = max(1, round(w * f)), max(1, round(h * f))
    how = cv2.INTER_NEAREST if picture.ndim == 2 else cv2.INTER_AREA
    x, y = (side - w2) // 2, (side - h2) // 2
    out = np.zeros((side, side) + picture.shape[2:], np.uint8)
    out[y:y + h2, x:x + w2] = cv2.resize(picture, (w2, h2), interpolation=how)
    return out, (x / side, y / side, (x + w2) / side, (y + h2) / side)


def read(path):
    """An RGB picture."""
    return cv2.imread(path)[:, :, ::-1]


def thumbs(paths):
    """Small grey pictures, each of mean 0 and length 1, to find the same photo again."""
    rows = []
    for p in paths:
        t = cv2.resize(cv2.imread(p, 0), (16, 16), interpolation=cv2.INTER_AREA).astype(np.float32).ravel()
        t -= t.mean()
        rows.append(t / (np.linalg.norm(t) + 1e-6))
    return np.array(rows)


def table():
    """Rows of labels.csv with the kind's index (-1 where unusable)."""
    with open(f"{DATA}/clothing/labels.csv") as f:
        rows = list(csv.DictReader(f))
    for r in rows:
        r["index"] = KINDS.index(NAMES[r["kind"]]) if r["kind"] in NAMES else -1
    return rows


def split(path=None, aim=500, largest=100):
    """File names to learn from and to keep apart; written once, then read.

    Senders of at most `largest` pictures are drawn by SEED until `aim` usable
    pictures and 6 of every kind are apart. Photos of clothing_full, and photos
    that look the same as the ones in photos/, are used for neither.
    """
    path = path or f"{WORK}/split.json"
    if os.path.exists(path):
        with open(path) as f:
            return json.load(f)
    rows = table()
    by = {}
    for r in rows:
        by.setdefault(r["sender"], []).append(r)
    order = sorted(s for s in by if len(by[s]) <= largest)
    np.random.default_rng(SEED).shuffle(order)
    apart, count = [], np.zeros(len(KINDS), int)
    for s in order:
        kinds = [r["index"] for r in by[s] if r["index"] >= 0]
        if count.sum() < aim or any(count[k] < 6 for k in kinds):
            apart.append(s)
            np.add.at(count, kinds, 1)
    full = {os.path.basename(p) for p in glob.glob(f"{DATA}/clothing_full/*.jpg")}
    seen = thumbs([f"{DATA}/clothing/{r['file']}" for r in rows]) @ thumbs(sorted(glob.glob(f"{DATA}/photos/*.jpg"))).T
    same = {rows[i]["file"] for i in np.nonzero(seen.max(1) > .97)[0]}
    out = {"seed": SEED, "senders": apart, "same_as_photos": sorted(same),
           "apart": [r["file"] for r in rows if r["sender"] in apart],
           "learn": [r["file"] for r in rows if r["sender"] not in apart and r["file"] not in full | same]}
    with open(path, "w") as f:
        json.dump(out, f)
    return out


class Real:
    """Real photos in memory: kinds known, parts and the rest unknown or given by hand."""

    def __init__(self, files, by_hand=None):
        kinds = {r["file"]: r["index"] for r in table()}
        n = len(files)
        self.files = files
        self.image = torch.zeros(n, SIDE, SIDE, 3, dtype=torch.uint8)
        self.box = torch.zeros(n, 4)
        self.read_photos()
        self.kind = torch.tensor([kinds[f] for f in files])
        self.parts = torch.full((n, SIDE, SIDE), UNKNOWN, dtype=torch.uint8)
        self.marks = torch.full((n, len(LANDMARKS), 3), -1.0)
        self.lies = torch.full((n, 4), -1)
        self.flags = torch.full((n, 3), -1.0)
        self.fixed = torch.zeros(n, dtype=torch.bool)
        if by_hand:
            self.read_by_hand(by_hand)
        share = torch.bincount(self.kind + 1, minlength=len(KINDS) + 1).float()
        self.odds = share[self.kind + 1].rsqrt() * torch.where(self.kind < 0, 0.5, 1.0)

    def read_photos(self):
        """The photos, decoded once and then kept as a file beside the split."""
        key = hashlib.sha256(" ".join([str(SIDE)] + self.files).encode()).hexdigest()[:12]
        kept = f"{WORK}/photos-{key}.pt"
        if os.path.exists(kept):
            self.image, self.box = torch.load(kept)
            return
        for i, name in enumerate(self.files):
            image, box = letterbox(read(f"{DATA}/clothing/{name}"))
            self.image[i], self.box[i] = torch.from_numpy(image), torch.tensor(box)
        torch.save((self.image, self.box), kept)

    def read_by_hand(self, folder):
        """Part maps (NAME.png) and landmarks (NAME.json) given for some photos."""
        for i, name in enumerate(self.files):
            stem = os.path.join(folder, os.path.splitext(name)[0])
            x0, y0, x1, y1 = self.box[i].tolist()
            if os.path.exists(stem + ".png"):
                self.parts[i] = torch.from_numpy(letterbox(cv2.imread(stem + ".png", 0))[0])
                self.fixed[i] = True
            if os.path.exists(stem + ".json"):
                h, w = cv2.imread(f"{DATA}/clothing/{name}", 0).shape
                with open(stem + ".json") as f:
                    given = json.load(f)
                for word, at in given.items():
                    self.marks[i, LANDMARKS.index(word)] = torch.tensor(
                        [x0 + at[0] / w * (x1 - x0), y0 + at[1] / h * (y1 - y0), 1.0])
                self.fixed[i] = True

    def draw(self, n):
        return torch.multinomial(self.odds, n, replacement=n > len(self.odds))


class Drawn:
    """Drawn pictures in memory; folders with a truth file are taken in as they appear."""

    def __init__(self, pool, limit=25000):
        self.pool, self.limit, self.seen, self.count = pool, limit, set(), 0
        self.image = torch.zeros(0, SIDE, SIDE, 3, dtype=torch.uint8)
        self.keep = {}
        self.grow()

    def grow(self):
        """True when new pictures were taken in."""
        before = self.count
        for path in sorted(glob.glob(f"{self.pool}/*/truth*.npz")):
            if path in self.seen or self.count >= self.limit:
                continue
            try:
                self.take(path)
            except (OSError, EOFError, ValueError) as why:
                print("left out", path, why, flush=True)
            self.seen.add(path)
        return self.count > before

    def take(self, path):
        """The pictures of one truth file."""
        with np.load(path) as f:
            truth = {k: f[k] for k in f.files}
        n, size = len(truth["kind"]), truth["parts"].shape[1]
        first = int(truth.get("first", 0))
        image = np.zeros((n, SIDE, SIDE, 3), np.uint8)
        parts = np.zeros((n, SIDE, SIDE), np.uint8)
        for i in range(n):
            whole = read(os.path.join(os.path.dirname(path), f"{first + i:05d}.jpg"))
            image[i] = cv2.resize(whole, (SIDE, SIDE), interpolation=cv2.INTER_AREA)
            parts[i] = cv2.resize(truth["parts"][i], (SIDE, SIDE), interpolation=cv2.INTER_NEAREST)
        marks = truth["landmarks"].astype(np.float32)
        marks[..., :2] = (marks[..., :2] + 0.5) / size
        flags = np.stack([truth[k] for k in ("hanger", "flat", "whole")], 1).astype(np.float32)
        new = {"image": image, "parts": parts, "marks": marks, "flags": flags,
               "kind": truth["kind"].astype(np.int64), "lies": truth["lies"].astype(np.int64)}
        for k, v in new.items():
            self.keep.setdefault(k, []).append(torch.from_numpy(v))
        self.count += n

    def pick(self, at):
        """Pictures by number; chunks stay apart in memory so that growing copies nothing."""
        ends = np.cumsum([len(c) for c in self.keep["kind"]])
        at = np.asarray(at)
        chunk = np.searchsorted(ends, at, side="right")
        row = at - np.concatenate([[0], ends[:-1]])[chunk]
        return {k: torch.stack([v[c][r] for c, r in zip(chunk, row)]) for k, v in self.keep.items()}

    def draw(self, n):
        return self.pick(np.random.randint(self.count, size=n))

    def habits(self):
        """Shares of each kind's pictures that hold each part, and each landmark."""
        kind = torch.cat(self.keep["kind"])
        marks = (torch.cat(self.keep["marks"])[..., 2] > 0).float()
        holds = torch.cat([torch.stack([(c == p).flatten(1).sum(1) > 20 for p in range(len(PARTS))], 1)
                           for c in self.keep["parts"]]).float()
        rows = [kind == k for k in range(len(KINDS))]
        mean = lambda v: torch.stack([v[r].mean(0) if r.any() else torch.ones(v.shape[1]) for r in rows])
        return mean(holds), mean(marks)


def uniform(n, low, high):
    return torch.rand(n) * (high - low) + low


def chance(n, p):
    return torch.rand(n) < p


def geometry(n, strength=1.0):
    """Matrices from output to input places (-1..1), and which pictures are mirrored."""
    turn = torch.randn(n) * 0.15 * strength
    turn = torch.where(chance(n, 0.08 * strength), uniform(n, -0.8, 0.8), turn)
    scale = torch.exp(uniform(n, -0.22, 0.16) * strength)
    aspect = torch.exp(torch.randn(n) * 0.07 * strength)
    flip = chance(n, 0.5)
    c, s = turn.cos(), turn.sin()
    sx, sy = scale * aspect * torch.where(flip, -1.0, 1.0), scale / aspect
    lean = torch.randn(n) * 0.06 * strength
    m = torch.stack([torch.stack([c * sx, -s * sy + lean, uniform(n, -.12, .12) * strength], 1),
                     torch.stack([s * sx, c * sy, uniform(n, -.12, .12) * strength], 1)], 1)
    return m, flip


def sample(image, m, size, mode="bilinear"):
    """Pictures [n,c,h,w] seen through matrices m at size x size; black outside."""
    grid = F.affine_grid(m, [len(image), 1, size, size], align_corners=False)
    return F.grid_sample(image, grid, mode=mode, padding_mode="zeros", align_corners=False)


def move(marks, m, flip):
    """Landmarks (0..1) where the views show them; those out of view are absent."""
    out = torch.where(flip[:, None, None], marks[:, MIRROR_MARKS], marks)
    at = out[..., :2] * 2 - 1 - m[:, None, :, 2]
    at = torch.linalg.solve(m[:, :, :2], at.transpose(1, 2)).transpose(1, 2) * 0.5 + 0.5
    inside = ((at > 0) & (at < 1)).all(2)
    have = torch.where((out[..., 2] > 0) & ~inside, torch.zeros(()), out[..., 2])
    return torch.cat([at, have[..., None]], 2)


def target(parts, m, flip, size):
    """Shares of parts per cell [n,11,size/4,size/4]; unknown places hold no share."""
    parts = torch.where(flip[:, None, None], MIRROR_PARTS[parts.long()], parts)
    near = sample(parts[:, None].float(), m, size // 2, "nearest")[:, 0].long()
    one = F.one_hot(near.clamp(max=len(PARTS)), len(PARTS) + 1)[..., :len(PARTS)]
    return F.avg_pool2d(one.permute(0, 3, 1, 2).float(), 2)


def light(image, strength=1.0):
    """Colour, brightness, uneven light, blur and noise changed at random."""
    n, _, h, w = image.shape
    e = strength
    gain = torch.exp(torch.randn(n, 1, 1, 1) * .2 * e + torch.randn(n, 3, 1, 1) * .08 * e)
    image = image.clamp(1e-3, 1) ** torch.exp(torch.randn(n, 1, 1, 1) * .22 * e) * gain
    mean = image.mean((1, 2, 3), keepdim=True)
    image = mean + (image - mean) * torch.exp(torch.randn(n, 1, 1, 1) * .2 * e)
    grey = image.mean(1, keepdim=True)
    dull = torch.where(chance(n, .1 * e)[:, None, None, None], torch.zeros(()), uniform(n, 1 - .6 * e, 1 + .5 * e)[:, None, None, None])
    image = grey + (image - grey) * dull
    mix = chance(n, .25 * e)
    if mix.any():
        image[mix] = image[mix][:, torch.randperm(3)]
    field = F.interpolate(torch.randn(n, 1, 3, 3), size=(h, w), mode="bicubic", align_corners=False)
    image = image * torch.exp(field * uniform(n, 0, .25 * e)[:, None, None, None])
    soft = chance(n, .3)
    if soft.any():
        tap = float(uniform(1, .1, .33))
        line = torch.tensor([tap, 1 - 2 * tap, tap])
        kernel = (line[:, None] * line[None])[None, None].repeat(3, 1, 1, 1)
        image[soft] = F.conv2d(F.pad(image[soft], (1, 1, 1, 1), mode="reflect"), kernel, groups=3)
    image = image + torch.randn_like(image) * uniform(n, 0, .03 * e)[:, None, None, None]
    return image.clamp(0, 1)


def cut(image, p=.4):
    """Small rectangles of one colour over some pictures."""
    n, _, h, w = image.shape
    for i in torch.nonzero(chance(n, p))[:, 0].tolist():
        for _ in range(int(torch.randint(1, 4, (1,)))):
            a, b = (torch.rand(2) * .18 * h + 2).int().tolist()
            y, x = int(torch.randint(0, h - a, (1,))), int(torch.randint(0, w - b, (1,)))
            image[i, :, y:y + a, x:x + b] = torch.rand(3, 1, 1)
    return image


def grounds(real, n):
    """Grounds [n,3,SIDE,SIDE] made of mirrored corners of real photos."""
    at = torch.randint(len(real.kind), (n,))
    box = real.box[at] * 2 - 1
    part = uniform(n, .18, .34)[:, None]
    size = (box[:, 2:] - box[:, :2]) * part
    corner = torch.randint(0, 2, (n, 2)).float()
    start = box[:, :2] + corner * (box[:, 2:] - box[:, :2] - size)
    line = torch.linspace(0, 1, SIDE)
    repeat = uniform(n, 1.0, 3.0)[:, None]
    fold = 1 - (1 - (line[None] * repeat + torch.rand(n, 1)) % 2).abs()
    x = start[:, :1] + fold * size[:, :1]
    y = start[:, 1:] + fold * size[:, 1:]
    grid = torch.stack([x[:, None].expand(n, SIDE, SIDE), y[:, :, None].expand(n, SIDE, SIDE)], 3)
    return F.grid_sample(real.image[at].permute(0, 3, 1, 2).float() / 255, grid, align_corners=False)


def paste(image, parts, real, p=.4):
    """Drawn garments with real grounds behind some of them; half keep the drawn shade."""
    at = torch.nonzero(chance(len(image), p))[:, 0]
    if len(at) == 0:
        return image
    over = (parts[at] > 0).float()[:, None]
    soft = F.avg_pool2d(over, 3, 1, 1)
    new, old = grounds(real, len(at)), image[at]
    grey = F.avg_pool2d(old.mean(1, keepdim=True) * (1 - over), 9, 1, 4) / F.avg_pool2d(1 - over, 9, 1, 4).clamp(min=.05)
    usual = (grey * (1 - over)).sum((2, 3), keepdim=True) / (1 - over).sum((2, 3), keepdim=True).clamp(min=1)
    shade = (grey / usual.clamp(min=.05)).clamp(.35, 1.3)
    shade = torch.where(chance(len(at), .5)[:, None, None, None], shade, torch.ones(()))
    image[at] = old * soft + (new * shade).clamp(0, 1) * (1 - soft)
    return image


def views(batch, size, strength=1.0, real=None):
    """An augmented batch from stored pictures: picture, target, marks, kind, lies, flags."""
    n = len(batch["kind"])
    image = batch["image"].permute(0, 3, 1, 2).float() / 255
    if real is not None:
        image = paste(image, batch["parts"], real)
    m, flip = geometry(n, strength)
    lies = torch.where(flip[:, None], batch["lies"][:, MIRROR_LIMBS], batch["lies"])
    return {"picture": cut(light(sample(image, m, size), strength)),
            "target": target(batch["parts"], m, flip, size),
            "marks": move(batch["marks"], m, flip), "kind": batch["kind"], "lies": lies, "flags": batch["flags"]}


def together(a, b):
    return {k: torch.cat([a[k], b[k]]) for k in a}


def shrink(image, size):
    """Stored pictures as network input at size x size."""
    x = image.permute(0, 3, 1, 2).float() / 255
    return x if x.shape[2] == size else F.interpolate(x, size=(size, size), mode="area" if size < x.shape[2] else "bilinear")

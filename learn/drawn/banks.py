"""Banks of noise and of real textures that every picture draws from.

Noise: periodic fields made once by filtering white noise in the frequency
domain; pictures sample them at random places, so that one picture pays a
remap only. Real textures: grounds from the rims of training photos and cloth
from their centres, cut once and kept as .npy files in the cache folder.
Photos that serve for judging are left out. Without the photos the program
draws with made textures only. Cost: about 0.3 s at import, about 40 s for the
first cut of the photos.
"""

import csv
import os

import cv2
import numpy as np

DATA = os.environ.get("DRAW_DATA", "data")
CACHE = os.environ.get("DRAW_CACHE", os.path.join("out", "draw"))
N = 512
GROUND = 256
CLOTH = 96

cv2.setNumThreads(1)


def band(seed, low, high, stretch=1.0):
    """Periodic noise with wavelengths from low to high pixels, deviation 1."""
    rng = np.random.default_rng(seed)
    spectrum = np.fft.rfft2(rng.standard_normal((N, N)))
    fy = np.fft.fftfreq(N)[:, None] * stretch
    fx = np.fft.rfftfreq(N)[None, :]
    f = np.sqrt(fx * fx + fy * fy)
    keep = np.exp(-(f * low) ** 2) * (1 - np.exp(-(f * high) ** 2))
    field = np.fft.irfft2(spectrum * keep, s=(N, N))
    field -= field.mean()
    return (field / (field.std() + 1e-9)).astype(np.float32)


def slope(height):
    """The derivative of a height field along x: the shading by a side light."""
    d = np.roll(height, -1, 1) - np.roll(height, 1, 1)
    return np.clip(d / (d.std() + 1e-9), -3, 3).astype(np.float32)


def ridged(seed, low, high, stretch):
    """Shading of sharp creases: ridges where smooth noise crosses zero."""
    a = band(seed, low, high, stretch)
    height = np.exp(-np.abs(a) * 4) * (0.5 + band(seed + 1, 80, 300))
    return slope(cv2.GaussianBlur(height.astype(np.float32), (0, 0), 1.2))


def twist(field, amount, seed):
    """A field moved by smooth noise, so that its folds bend."""
    yy, xx = np.mgrid[0:N, 0:N].astype(np.float32)
    dx, dy = band(seed, 60, 300) * amount, band(seed + 1, 60, 300) * amount
    return cv2.remap(field, xx + dx, yy + dy, cv2.INTER_LINEAR,
                     borderMode=cv2.BORDER_WRAP)


FINE = [band(1, 2, 6), band(2, 3, 12)]
NOISE = np.random.default_rng(6).standard_normal((N * 2, N * 2, 3)).astype(np.float32)
GRAIN = band(3, 2, 8, 0.12)
CLOUD = [band(4, 25, 120), band(5, 40, 260), band(6, 12, 60)]
BROAD = [twist(slope(band(11 + i, 30, 160, s)), 8, 30 + i)
         for i, s in enumerate((0.6, 0.35, 0.2))]
CREASE = [twist(ridged(21 + 2 * i, w, 6 * w, s), 7, 40 + i)
          for i, (w, s) in enumerate(((16, 0.35), (26, 0.2), (20, 0.5), (40, .3)))]


def sample(field, rng, w, h, scale=1.0, angle=None):
    """A w by h window of a periodic field, zoomed by scale and turned."""
    a = rng.uniform(0, 2 * np.pi) if angle is None else angle
    c, s = np.cos(a) / scale, np.sin(a) / scale
    m = np.array([[c, -s, rng.uniform(0, N)], [s, c, rng.uniform(0, N)]])
    return cv2.warpAffine(field, m, (w, h), borderMode=cv2.BORDER_WRAP,
                          flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP)


def photo_names():
    """Names of the photos that may be learnt from, in a fixed order."""
    folder = os.path.join(DATA, "clothing")
    kept = set(os.listdir(os.path.join(DATA, "clothing_full")))
    with open(os.path.join(folder, "labels.csv")) as f:
        names = [r["file"] for r in csv.DictReader(f)]
    return [os.path.join(folder, n) for n in names if n not in kept]


def fill_from_strip(strip, side, rng):
    """A square texture from a rim strip: its median profile with the strip's
    detail laid over it again and again, shifted and mirrored, ends blended."""
    s = strip if side < 2 else strip.transpose(1, 0, 2)
    s = cv2.resize(s, (GROUND, s.shape[0])).astype(np.float32)
    d, fade = len(s), max(4, len(s) // 3)
    profile = np.median(s, 0)
    detail = s - profile
    detail = np.clip(detail - cv2.blur(detail, (41, 41)) * 0.6, -45, 45)
    total, weight = np.zeros((GROUND + d, GROUND, 3)), np.full((GROUND + d, 1, 1), 1e-6)
    ramp = np.minimum(1, np.minimum(np.arange(1, d + 1), np.arange(d, 0, -1)) / fade)
    for y in range(0, GROUND, d - fade):
        piece = np.roll(detail, int(rng.integers(GROUND)), 1)
        piece = piece[:, ::-1] if rng.random() < 0.5 else piece
        total[y:y + d] += piece * ramp[:, None, None]
        weight[y:y + d] += ramp[:, None, None] ** 2
    out = np.clip(profile + (total / np.sqrt(weight))[:GROUND], 0, 255).astype(np.uint8)
    return out if side < 2 else np.ascontiguousarray(out.transpose(1, 0, 2))


def cut_ground(img, rng):
    """A ground texture from a photo's best rim, or None if none is clear."""
    h, w = img.shape[:2]
    d = int(0.11 * min(h, w))
    strips = [img[:d], img[-d:], img[:, :d], img[:, -d:]]
    centre = np.median(img[h // 3:2 * h // 3, w // 3:2 * w // 3].reshape(-1, 3), 0)
    best, score = None, 0
    for side, s in enumerate(strips):
        far = np.abs(s.astype(np.float32) - centre).mean(2)
        blocks = cv2.resize(s, (8, 8), interpolation=cv2.INTER_AREA)
        value = np.percentile(far, 4) - 0.6 * blocks.astype(float).std((0, 1)).mean()
        if value > score:
            best, score = (s, side), value
    return fill_from_strip(*best, rng) if best is not None and score > 12 else None


def cut_cloth(img):
    """The cloth in the middle of a photo, 96 by 96 pixels, or None."""
    h, w = img.shape[:2]
    y, x = (h - CLOTH) // 2, (w - CLOTH) // 2
    c = img[y:y + CLOTH, x:x + CLOTH]
    inner = img[y + 24:y + 72, x + 24:x + 72].reshape(-1, 3).mean(0)
    rim = np.concatenate([img[:8].reshape(-1, 3), img[-8:].reshape(-1, 3)]).mean(0)
    return c if np.abs(inner - rim).mean() > 10 else None


def cut_all():
    """The cache files of grounds and cloth, written from the photos."""
    grounds, cloths = [], []
    names = photo_names()
    rng = np.random.default_rng(7)
    order = rng.permutation(len(names))
    for i in order:
        img = cv2.imread(names[i])
        if img is None or min(img.shape[:2]) < 200:
            continue
        img = img[:, :, ::-1]
        if len(grounds) < 900:
            g = cut_ground(img, rng)
            if g is not None:
                grounds.append(g)
        if len(cloths) < 1500:
            c = cut_cloth(img)
            if c is not None:
                cloths.append(c)
        if len(grounds) >= 900 and len(cloths) >= 1500:
            break
    os.makedirs(CACHE, exist_ok=True)
    for name, a in (("grounds", grounds), ("cloths", cloths)):
        part = os.path.join(CACHE, f"{name}.{os.getpid()}.npy")
        np.save(part, np.array(a, np.uint8))
        os.replace(part, os.path.join(CACHE, name + ".npy"))


def load(name):
    """An array of real textures, or None where there are no photos."""
    path = os.path.join(CACHE, name + ".npy")
    if not os.path.exists(path):
        if not os.path.exists(os.path.join(DATA, "clothing", "labels.csv")):
            return None
        cut_all()
    return np.load(path, mmap_mode="r")


REAL_GROUNDS = load("grounds")
REAL_CLOTHS = load("cloths")


def even(cloths):
    """The indices of cloth pieces without big borders within them."""
    small = np.array([cv2.resize(c, (4, 4), interpolation=cv2.INTER_AREA) for c in cloths])
    spread = small.astype(np.float32).std((1, 2)).mean(1)
    return np.flatnonzero(spread < 15)


EVEN_CLOTHS = None if REAL_CLOTHS is None else even(REAL_CLOTHS)

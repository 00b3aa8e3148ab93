"""Draws photos of garments laid flat, with their exact truth, to learn from.

Method: a garment of random measures is built from outlines in centimetres,
its limbs are bent or folded, the pieces are laid over each other on a ground,
lit, and seen by a phone's camera. The same polygons give the picture and the
truth. A seed always gives the same picture. Cost: about 35 ms of one core for
a picture of 256 pixels; the first start cuts real textures for some minutes.

DRAW_DATA and DRAW_CACHE name the folders of photos and of cut textures.

    python draw.py --count N --seed S --size 256 --out FOLDER
    python draw.py --count 48 --seed S --sheet FILE.png
"""

import argparse
import os
import sys

import cv2
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from drawn import garments, scene  # noqa: E402
from words import KINDS, LIES, LIMBS  # noqa: E402

ODDS = np.array([1, .9, 1.35, 1.25, .95, 1, .9, 1.3, 1.3, 1.25, 1, .85])
SHEET_COLOURS = np.array([[0, 0, 0], [90, 90, 220], [60, 200, 60], [220, 200, 40],
                          [40, 200, 200], [230, 110, 30], [200, 60, 200], [255, 255, 255],
                          [150, 40, 40], [255, 160, 200], [130, 130, 130]], np.uint8)


def picture(seed, size=256):
    """One picture with its truth, the same for the same seed."""
    rng = np.random.default_rng([seed, 20])
    kind = int(rng.choice(len(KINDS), p=ODDS / ODDS.sum()))
    g = garments.make(rng, KINDS[kind], hung=rng.random() < .12)
    img, part, marks, whole = scene.photo(rng, g, size)
    h, w = img.shape[:2]
    x, y = (size - w) // 2, (size - h) // 2
    image = np.zeros((size, size, 3), np.uint8)
    parts = np.zeros((size, size), np.uint8)
    image[y:y + h, x:x + w], parts[y:y + h, x:x + w] = img, part
    marks[marks[:, 2] > 0, :2] += (x, y)
    lies = np.array([LIES.index(g.lies[limb]) for limb in LIMBS], np.uint8)
    return dict(image=image, parts=parts, kind=kind, landmarks=marks, lies=lies,
                hanger=bool(g.hanger), flat=bool(g.flat), whole=bool(whole))


def write(folder, seed, count, size):
    """Pictures as JPEG files, and their truth in one file per 1000."""
    os.makedirs(folder, exist_ok=True)
    for start in range(0, count, 1000):
        batch = []
        for i in range(start, min(start + 1000, count)):
            p = picture(seed + i, size)
            cv2.imwrite(os.path.join(folder, f"{i:05d}.jpg"), p.pop("image")[:, :, ::-1],
                        [cv2.IMWRITE_JPEG_QUALITY, 90])
            batch.append(p)
        name = "truth.npz" if count <= 1000 else f"truth{start // 1000:03d}.npz"
        np.savez_compressed(os.path.join(folder, name), first=start,
                            **{k: np.array([b[k] for b in batch]) for k in batch[0]})


def cell(p):
    """One picture beside its truth in colours."""
    truth = SHEET_COLOURS[p["parts"]]
    for x, y, seen in p["landmarks"]:
        if seen:
            cv2.circle(truth, (int(round(x)), int(round(y))), 3, (255, 0, 0), -1)
    lies = " ".join(f"{LIMBS[i][0]}{LIMBS[i].split('_')[1][0]}:{LIES[v]}"
                    for i, v in enumerate(p["lies"]) if v)
    both = np.hstack([p["image"], truth])
    cv2.putText(both, KINDS[p["kind"]] + " " + lies, (2, 10), 0, .36, (255, 255, 0), 1)
    return both


def sheet(path, seed, count, size):
    """A contact sheet, four pairs in a row."""
    cells = [cell(picture(seed + i, size)) for i in range(count - count % 4)]
    rows = [np.hstack(cells[i:i + 4]) for i in range(0, len(cells), 4)]
    cv2.imwrite(path, np.vstack(rows)[:, :, ::-1])


def main():
    a = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    a.add_argument("--count", type=int, default=24)
    a.add_argument("--seed", type=int, default=0)
    a.add_argument("--size", type=int, default=256)
    a.add_argument("--out")
    a.add_argument("--sheet")
    a = a.parse_args()
    if a.sheet:
        sheet(a.sheet, a.seed, a.count, a.size)
    if a.out:
        write(a.out, a.seed, a.count, a.size)


if __name__ == "__main__":
    main()

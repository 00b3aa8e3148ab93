"""Figures of the trained weights on pictures they never saw.

What: kinds on the real photos of kept-apart senders (first guess, first two,
    table of mistakes); mask and parts on drawn pictures of other seeds (intersection over
    union), landmarks there (distance over the picture's width, share within
    5 %), lies and flags; masks on photos outlined by hand; and a sheet of
    kept-apart photos with the parts laid over them, to look at.
Source: the kept-apart list of data.split; masks by hand under photos/masks.
Cost: about a minute of one core.

    python score.py --weights FILE.pt [--size 192] [--json FILE] [--sheet FILE.jpg]
"""
import argparse
import glob
import json
import os

import cv2
import numpy as np
import torch

import data
from net import FLAGS, LIMBS, Net, places
from words import KINDS, LANDMARKS, LIES, PARTS

COLOURS = np.array([[0, 0, 0], [90, 90, 220], [60, 200, 60], [220, 200, 40], [40, 200, 200], [230, 110, 30],
                    [200, 60, 200], [255, 255, 255], [150, 40, 40], [255, 160, 200], [130, 130, 130]], np.uint8)
GARMENT = [i for i, p in enumerate(PARTS) if p not in ("ground", "hanger")]


@torch.no_grad()
def see(net, image, size, batch=32):
    """Outputs for stored pictures, batch after batch, put together."""
    net.eval()
    rows = [net(data.shrink(image[i:i + batch], size).contiguous(memory_format=torch.channels_last))
            for i in range(0, len(image), batch)]
    return {k: torch.cat([r[k] for r in rows]) for k in rows[0]}


def full(parts, side=data.SIDE):
    """The likeliest part at every place of the stored picture."""
    return torch.cat([torch.nn.functional.interpolate(p[None], size=(side, side), mode="bilinear").argmax(1) for p in parts])


def on_senders(net, apart, size):
    """Kinds on kept-apart real photos."""
    use = apart.kind >= 0
    out = see(net, apart.image[use], size)["kinds"]
    kind = apart.kind[use]
    order = out.argsort(1, descending=True)
    hit = order == kind[:, None]
    table = np.zeros((len(KINDS), len(KINDS)), int)
    np.add.at(table, (kind.numpy(), order[:, 0].numpy()), 1)
    each = [float(hit[kind == k, 0].float().mean()) if (kind == k).any() else None for k in range(len(KINDS))]
    return {"photos": len(kind), "top1": float(hit[:, 0].float().mean()), "top2": float(hit[:, :2].any(1).float().mean()),
            "mean_over_kinds": float(np.mean([e for e in each if e is not None])),
            "each": dict(zip(KINDS, each)), "table": table.tolist()}


def overlap(a, b):
    """Sum of intersections and of unions of two masks."""
    return int((a & b).sum()), int((a | b).sum())


def on_drawn(net, judge, size):
    """Parts, landmarks, kinds, lies and flags on drawn pictures with exact truth."""
    p = judge.pick(range(judge.count))
    out = see(net, p["image"], size)
    found, true = full(out["parts"]), p["parts"].long()
    cover = lambda x: torch.isin(x, torch.tensor(GARMENT))
    got, want = cover(found), cover(true)
    each = [overlap(a, b) for a, b in zip(got, want)]
    parts = {}
    for k, name in enumerate(PARTS):
        both, either = overlap(found == k, true == k)
        parts[name] = both / max(1, either)
    at, _ = places(out["landmarks"])
    have = p["marks"][..., 2] > 0
    off = (at - p["marks"][..., :2]).norm(dim=2)
    lies = out["lies"].view(-1, LIMBS, len(LIES)).argmax(2)
    limb = p["lies"] > 0
    here = (out["presence"] > 0) == have
    return {"pictures": judge.count, "mask": float(np.mean([a / max(1, b) for a, b in each])), "parts": parts,
            "parts_mean": float(np.mean(list(parts.values()))), "landmarks_median": float(off[have].median()),
            "within_5_percent": float((off[have] < .05).float().mean()),
            "landmarks_each": {n: float(off[:, i][have[:, i]].median()) for i, n in enumerate(LANDMARKS) if have[:, i].any()},
            "presence": float(here.float().mean()), "kinds": float((out["kinds"].argmax(1) == p["kind"]).float().mean()),
            "lies_all": float((lies == p["lies"]).float().mean()), "lies_of_limbs": float((lies == p["lies"])[limb].float().mean()),
            "flags": dict(zip(FLAGS, ((out["flags"] > 0).float() == p["flags"]).float().mean(0).tolist()))}


def by_hand(net, size):
    """Masks against outlines by hand, at the photo's own size."""
    rows = {}
    for path in sorted(glob.glob(f"{data.DATA}/photos/masks/*.png")):
        stem = os.path.splitext(os.path.basename(path))[0]
        image, mask = data.read(f"{data.DATA}/photos/{stem}.jpg"), cv2.imread(path, 0) > 127
        square, box = data.letterbox(image)
        with torch.no_grad():
            parts = net(data.shrink(torch.from_numpy(square)[None], size))["parts"][0].softmax(0)
        cover = parts[GARMENT].sum(0).numpy()
        h, w = mask.shape
        side = max(h, w)
        big = cv2.resize(cover, (side, side), interpolation=cv2.INTER_LINEAR)
        y, x = round(box[1] * side), round(box[0] * side)
        got = big[y:y + h, x:x + w] > .5
        both, either = overlap(got, mask[:got.shape[0], :got.shape[1]])
        rows[stem] = both / max(1, either)
    return {"photos": len(rows), "mask": float(np.mean(list(rows.values()))), "median": float(np.median(list(rows.values()))), "each": rows}


def overlay(image, parts, marks, here):
    """A picture with its parts in colour and the landmarks that are there."""
    part = COLOURS[parts]
    out = np.ascontiguousarray(np.where((parts > 0)[..., None], image * .45 + part * .55, image).astype(np.uint8))
    for (x, y), h in zip(marks, here):
        if h > 0:
            cv2.circle(out, (int(x * out.shape[1]), int(y * out.shape[0])), 2, (255, 0, 0), -1)
    return out


def sheet(net, apart, size, path, count=40):
    """Kept-apart photos beside their overlays, with the true and the found kind."""
    usable = torch.nonzero(apart.kind >= 0)[:, 0].numpy()
    at = np.random.default_rng(data.SEED).permutation(usable)[:count]
    out = see(net, apart.image[at], size)
    parts, (marks, _) = full(out["parts"]).numpy(), places(out["landmarks"])
    tiles = []
    for j, i in enumerate(at):
        image = apart.image[i].numpy()
        over = overlay(image, parts[j], marks[j].numpy(), out["presence"][j])
        tile = np.concatenate([image, over], 1)
        kind, guess = KINDS[apart.kind[i]], KINDS[int(out["kinds"][j].argmax())]
        cv2.putText(tile, f"{kind} > {guess}", (3, 11), 0, .38, (0, 255, 0) if kind == guess else (255, 60, 60), 1, cv2.LINE_AA)
        tiles.append(tile)
    rows = [np.concatenate(tiles[i:i + 5], 1) for i in range(0, len(tiles), 5)]
    cv2.imwrite(path, np.concatenate(rows, 0)[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, 88])


def tell(figures):
    """The figures in words."""
    k, d, m = figures["senders"], figures["drawn"], figures["by_hand"]
    print(f"kinds on {k['photos']} photos of kept-apart senders: {k['top1']:.3f}, first two {k['top2']:.3f}, mean over kinds {k['mean_over_kinds']:.3f}")
    print("true \\ found " + " ".join(f"{w[:6]:>6}" for w in KINDS))
    for word, row in zip(KINDS, k["table"]):
        print(f"{word:>12} " + " ".join(f"{v:6d}" for v in row))
    print(f"{d['pictures']} drawn pictures: mask {d['mask']:.3f}, mean of parts {d['parts_mean']:.3f}; " +
          " ".join(f"{n} {v:.2f}" for n, v in d["parts"].items()))
    print(f"landmarks: median {d['landmarks_median']:.4f} of the width, within 5 % {d['within_5_percent']:.3f}, there or not {d['presence']:.3f}")
    print(f"drawn kinds {d['kinds']:.3f}, lies {d['lies_all']:.3f} (limbs that are there {d['lies_of_limbs']:.3f}), flags {d['flags']}")
    print(f"masks by hand: mean {m['mask']:.3f}, median {m['median']:.3f} of {m['photos']}; worst " +
          ", ".join(f"{n} {v:.2f}" for n, v in sorted(m["each"].items(), key=lambda r: r[1])[:5]))


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("--weights", required=True)
    ask.add_argument("--size", type=int, default=192)
    ask.add_argument("--json")
    ask.add_argument("--sheet")
    a = ask.parse_args()
    torch.set_num_threads(1)
    net = Net().to(memory_format=torch.channels_last)
    net.load_state_dict(torch.load(a.weights, map_location="cpu", weights_only=False)["net"])
    net.eval()
    apart = data.Real(data.split()["apart"])
    judge = data.Drawn(os.path.join(data.WORK, "judge"), 500)
    figures = {"size": a.size, "senders": on_senders(net, apart, a.size), "drawn": on_drawn(net, judge, a.size),
               "by_hand": by_hand(net, a.size)}
    tell(figures)
    if a.json:
        with open(a.json, "w") as f:
            json.dump(figures, f, indent=1)
    if a.sheet:
        sheet(net, apart, a.size, a.sheet)


if __name__ == "__main__":
    main()

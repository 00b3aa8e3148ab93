"""Training: drawn pictures teach parts and landmarks, real photos teach kinds.

What: one command; stopped and started again it goes on from last.pt. Half of
    each batch is drawn, half real. Real photos give their kind and the parts
    that this kind never has; later a slow copy of the weights (mean of the
    steps) labels the parts it is sure of on the real photos, and these labels
    teach on. Weights for use are that slow copy.
Source: mean teacher, Tarvainen and Valpola 2017; self-training with a
    threshold after FixMatch, Sohn et al. 2020; AdamW, Loshchilov and Hutter 2019.
Cost: about 12 ms of one core per picture at size 128; the schedule follows the
    clock, from the first start to `--until`.

    python train.py --until HH:MM
"""
import argparse
import copy
import datetime
import math
import os
import time

import numpy as np
import torch
import torch.nn.functional as F

import data
from net import LIMBS, Net, places
from score import on_drawn, on_senders
from words import KINDS, LANDMARKS, LIES, PARTS

SEED = 20261129
SURE = 0.9
KEEP = 0.998
GOOD = 0.35
LABEL_EVERY, LABEL_MANY, LOOK_EVERY = 60, 256, 400
WEIGHTS = torch.tensor([.7, .8, 1.3, 1.3, 1.2, 1.2, 1.6, 1.6, 1.6, 1.6, 1.6])


def size_at(done, step=0):
    """Picture size by the share of the time that has passed; several near the end."""
    if done < .8:
        return 64 if done < .1 else 96 if done < .35 else (96, 128, 128, 160)[step % 4]
    return (192, 128, 160)[step % 3]


def rate_at(done, top):
    """Learning rate: short rise, then a cosine."""
    return top * min(1, done / .02 + .02) * (0.5 + 0.5 * math.cos(math.pi * min(1, done))) + 1e-6


def parts_loss(logits, target):
    """Cross-entropy on the shares of parts, over the places where they are known."""
    weight = target * WEIGHTS[None, :, None, None]
    return -(weight * logits.log_softmax(1)).sum() / weight.sum().clamp(min=1)


def never_loss(logits, kind, never):
    """Share given to parts that the picture's kind never has."""
    have = kind >= 0
    if not have.any():
        return logits.new_zeros(())
    off = (logits[have].softmax(1) * never[kind[have]][:, :, None, None]).sum(1)
    return -torch.log1p(-off.clamp(max=.999)).mean()


def marks_loss(heat, marks):
    """Divergence of the heat from a bell of one cell around each landmark."""
    n, k, h, w = heat.shape
    have = marks[..., 2] > 0
    if not have.any():
        return heat.new_zeros(())
    at = marks[have]
    x, y = torch.arange(w) + .5, torch.arange(h) + .5
    bell = torch.exp(-.5 * ((x[None] - at[:, :1] * w) ** 2))[:, None] * \
        torch.exp(-.5 * ((y[None] - at[:, 1:2] * h) ** 2))[:, :, None]
    bell = bell.flatten(1)
    bell = bell / bell.sum(1, keepdim=True).clamp(min=1e-6)
    return -(bell * heat[have].flatten(1).log_softmax(1)).sum(1).mean()


def losses(out, truth, drawn, never):
    """All losses by name; `drawn` pictures come first in the batch."""
    real = slice(drawn, None)
    first = slice(0, drawn)
    out = {k: v.float() for k, v in out.items()}
    known = truth["marks"][..., 2] >= 0
    flags = truth["flags"] >= 0
    lies = out["lies"].view(-1, LIMBS, len(LIES))
    got = {"parts": parts_loss(out["parts"][first], truth["target"][first]),
           "parts_real": parts_loss(out["parts"][real], truth["target"][real]),
           "never": never_loss(out["parts"][real], truth["kind"][real], never),
           "marks": marks_loss(out["landmarks"][first], truth["marks"][first]),
           "marks_real": marks_loss(out["landmarks"][real], truth["marks"][real]),
           "presence": F.binary_cross_entropy_with_logits(
               out["presence"][known], (truth["marks"][..., 2][known] > 0).float()),
           "kinds": F.cross_entropy(out["kinds"][first], truth["kind"][first]),
           "kinds_real": F.cross_entropy(out["kinds"][real], truth["kind"][real], ignore_index=-1, label_smoothing=.05),
           "lies": F.cross_entropy(lies.flatten(0, 1), truth["lies"].flatten(), ignore_index=-1),
           "flags": F.binary_cross_entropy_with_logits(out["flags"][flags], truth["flags"][flags])}
    return got


SHARES = {"parts": 1.0, "parts_real": .7, "never": .3, "marks": .15, "marks_real": .07, "presence": .3,
          "kinds": .25, "kinds_real": .7, "lies": .3, "flags": .2}


def follow(slow, net, step):
    """The slow copy moves a little towards the weights."""
    keep = min(KEEP, (1 + step) / (10 + step))
    with torch.no_grad():
        for a, b in zip(slow.state_dict().values(), net.state_dict().values()):
            if a.dtype.is_floating_point:
                a.lerp_(b, 1 - keep)
            else:
                a.copy_(b)


@torch.no_grad()
def label(slow, real, start, holds, marks_held, size, batch=32):
    """The slow copy's sure labels of LABEL_MANY real photos from `start`: parts, landmarks, lies.

    A photo and its mirror image are seen; their mean must reach SURE, their
    landmarks must agree within 0.04 of the side. Parts and landmarks that the
    known kind never has are ruled out first.
    """
    slow.eval()
    used = 0
    for i in range(start, start + LABEL_MANY, batch):
        at = torch.arange(i, i + batch) % len(real.kind)
        at = at[~real.fixed[at]]
        if len(at) == 0:
            continue
        x = data.shrink(real.image[at], size).contiguous(memory_format=torch.channels_last)
        a, b = slow(x), slow(x.flip(3))
        kind = real.kind[at]
        can = torch.where(kind[:, None] >= 0, (holds > .02).float()[kind.clamp(min=0)], torch.ones(len(PARTS)))
        p = (a["parts"].softmax(1) + b["parts"].softmax(1).flip(3)[:, data.MIRROR_PARTS[:len(PARTS)].long()]) / 2
        p = p * can[:, :, None, None]
        p = p / p.sum(1, keepdim=True).clamp(min=1e-6)
        p = F.interpolate(p, size=(data.SIDE, data.SIDE), mode="bilinear")
        top, part = p.max(1)
        new = torch.where(top > SURE, part, torch.full_like(part, data.UNKNOWN)).to(torch.uint8)
        box = (real.box[at] * data.SIDE).round().int().tolist()
        for j, (x0, y0, x1, y1) in enumerate(box):
            bars = torch.ones(data.SIDE, data.SIDE, dtype=torch.bool)
            bars[y0:y1, x0:x1] = False
            new[j][bars] = 0
        share = ((part > 0) & (part < 10)).float().mean((1, 2))
        fine = (share > .05) & (share < .9) & ((top > SURE).float().mean((1, 2)) > .6)
        real.parts[at] = torch.where(fine[:, None, None], new, real.parts[at])
        label_points(real, at, a, b, kind, marks_held)
        used += int(fine.sum())
    return used


def label_points(real, at, a, b, kind, marks_held):
    """Landmarks and lies of real photos where the picture and its mirror image agree."""
    one, peak1 = places(a["landmarks"])
    two, peak2 = places(b["landmarks"][:, data.MIRROR_MARKS])
    two[..., 0] = 1 - two[..., 0]
    here = (a["presence"].sigmoid() + b["presence"].sigmoid()[:, data.MIRROR_MARKS]) / 2
    can = torch.where(kind[:, None] >= 0, (marks_held > .01)[kind.clamp(min=0)], torch.ones(len(LANDMARKS), dtype=torch.bool))
    near = ((one - two).norm(dim=2) < .04) & (torch.minimum(peak1, peak2) > .5) & (here > .8) & can
    gone = (here < .05) | ~can
    have = torch.where(near, 1.0, torch.where(gone, 0.0, -1.0))
    real.marks[at] = torch.cat([(one + two) / 2, have[..., None]], 2)
    p = a["lies"].view(-1, LIMBS, len(LIES)).softmax(2)
    q = b["lies"].view(-1, LIMBS, len(LIES)).softmax(2)[:, data.MIRROR_LIMBS]
    top, lie = ((p + q) / 2).max(2)
    real.lies[at] = torch.where(top > .95, lie, torch.full_like(lie, -1))


def stored(real, at):
    return {k: getattr(real, k)[at] for k in ("image", "parts", "marks", "kind", "lies", "flags")}


def make_batch(drawn, real, half, size):
    """Half drawn, half real views, drawn first."""
    a = data.views(drawn.draw(half), size, real=real)
    b = data.views(stored(real, real.draw(half)), size)
    return data.together(a, b)


def save(path, run):
    """The state of the training, written whole or not at all."""
    torch.save(run, path + ".part")
    os.replace(path + ".part", path)


def clock(text):
    """Seconds of today's HH:MM."""
    h, m = map(int, text.split(":"))
    return datetime.datetime.now().replace(hour=h, minute=m, second=0, microsecond=0).timestamp()


class Run:
    """Everything that a checkpoint holds, and one step."""

    def __init__(self, a):
        torch.manual_seed(SEED)
        self.a = a
        self.net = Net().to(memory_format=torch.channels_last)
        self.slow = copy.deepcopy(self.net)
        self.opt = torch.optim.AdamW([{"params": [p for p in self.net.parameters() if p.ndim > 1]},
                                      {"params": [p for p in self.net.parameters() if p.ndim < 2], "weight_decay": 0.0}],
                                     lr=a.rate, weight_decay=.03)
        self.step, self.start, self.best, self.good, self.at = 0, time.time(), -1.0, 0.0, 0
        self.last = os.path.join(data.WORK, "last.pt")
        if os.path.exists(self.last):
            self.resume()

    def resume(self):
        got = torch.load(self.last, weights_only=False)
        self.net.load_state_dict(got["net_now"])
        self.slow.load_state_dict(got["net"])
        self.opt.load_state_dict(got["opt"])
        for k in ("step", "start", "best", "good", "at"):
            setattr(self, k, got[k])
        torch.manual_seed(SEED + self.step)
        np.random.seed((SEED + self.step) % 2**32)
        print("goes on from step", self.step, flush=True)

    def about(self, drawn):
        return {"seed": SEED, "step": self.step, "drawn": drawn.count, "half": self.a.half,
                "started": datetime.datetime.fromtimestamp(self.start).isoformat(timespec="seconds"),
                "until": self.a.until, "sizes": [64, 96, 128, 160, 192]}

    def save(self, drawn):
        save(self.last, {"net": self.slow.state_dict(), "net_now": self.net.state_dict(), "opt": self.opt.state_dict(),
                         "step": self.step, "start": self.start, "best": self.best, "good": self.good, "at": self.at, "about": self.about(drawn)})

    def one(self, batch, done, never):
        """One step; returns the losses as numbers."""
        for g in self.opt.param_groups:
            g["lr"] = rate_at(done, self.a.rate)
        self.net.train()
        out = self.net(batch["picture"].contiguous(memory_format=torch.channels_last))
        got = losses(out, batch, self.a.half, never)
        total = sum(SHARES[k] * v for k, v in got.items())
        self.opt.zero_grad(set_to_none=True)
        total.backward()
        torch.nn.utils.clip_grad_norm_(self.net.parameters(), 5.0)
        self.opt.step()
        self.step += 1
        follow(self.slow, self.net, self.step)
        return {k: float(v) for k, v in got.items()}


def look(run, apart, judge, drawn, done):
    """Short figures on kept-apart senders and unseen drawn pictures; the best is kept."""
    run.slow.eval()
    size = 128 if done < .8 else 160
    kinds = on_senders(run.slow, apart, size)
    parts = on_drawn(run.slow, judge, size)
    print(f"  kinds {kinds['top1']:.3f} {kinds['top2']:.3f}  parts {parts['parts_mean']:.3f} mask {parts['mask']:.3f} "
          f"landmarks {parts['landmarks_median']:.4f}", flush=True)
    figure = kinds["top1"] + parts["parts_mean"]
    if figure > run.best:
        run.best = figure
        save(os.path.join(data.WORK, "best.pt"), {"net": run.slow.state_dict(), "about": run.about(drawn)})
    return parts["parts_mean"]


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("--until", required=True)
    ask.add_argument("--half", type=int, default=16)
    ask.add_argument("--rate", type=float, default=2.5e-3)
    ask.add_argument("--threads", type=int, default=1)
    ask.add_argument("--steps", type=int, default=10**9)
    a = ask.parse_args()
    torch.set_num_threads(a.threads)
    np.random.seed(SEED % 2**32)
    names = data.split()
    drawn = data.Drawn(os.path.join(data.WORK, "pool"))
    judge = data.Drawn(os.path.join(data.WORK, "judge"), 300)
    real = data.Real(names["learn"], os.path.join(data.WORK, "real"))
    apart = data.Real(names["apart"])
    print(f"{drawn.count} drawn, {len(real.kind)} real, {len(apart.kind)} apart", flush=True)
    loop(Run(a), drawn, judge, real, apart, clock(a.until))


def loop(run, drawn, judge, real, apart, end):
    """Steps until the end time, with labels, figures and checkpoints between them."""
    holds, marks_held = drawn.habits()
    never = (holds < .005).float()
    saved = grown = t = time.time()
    mean, n = {}, 0
    while time.time() < end and run.step < run.a.steps:
        now = time.time()
        done = (now - run.start) / (end - run.start)
        if now - grown > 90:
            grown = now
            if drawn.grow():
                holds, marks_held = drawn.habits()
                never = (holds < .005).float()
        if run.good > GOOD and run.step % LABEL_EVERY == 0:
            used = label(run.slow, real, run.at, holds, marks_held, 128)
            run.at = (run.at + LABEL_MANY) % len(real.kind)
            print(f"  labelled {used} of {LABEL_MANY} real photos; places known "
                  f"{(real.parts[::16] != data.UNKNOWN).float().mean():.2f}", flush=True)
        size = size_at(done, run.step)
        got = run.one(make_batch(drawn, real, run.a.half, size), done, never)
        n += 1
        for k, v in got.items():
            mean[k] = mean.get(k, 0) + v
        if n == 50:
            print(f"{datetime.datetime.now():%H:%M:%S} {run.step} {done:.3f} size {size} drawn {drawn.count} {(time.time() - t) / n:.2f} s/step "
                  f"cpu {time.process_time() / 60:.1f} min " + " ".join(f"{k} {v / n:.3f}" for k, v in mean.items()), flush=True)
            mean, n, t = {}, 0, time.time()
        if run.step % LOOK_EVERY == 0:
            run.good = look(run, apart, judge, drawn, done)
        if time.time() - saved > 170:
            saved = time.time()
            run.save(drawn)
    look(run, apart, judge, drawn, 1.0)
    run.save(drawn)


if __name__ == "__main__":
    main()

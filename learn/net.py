"""The network: a photo of one garment in, its parts, landmarks, kind, lies and flags out.

What: a small residual encoder of plain 3x3 convolutions (strides 2 to 32), a
    decoder with skips back to stride 4, and six heads. Every operation is a
    convolution, ReLU, fixed-scale resize, concat, add, average over places,
    matrix product, softmax or sigmoid, so that a plain ONNX runtime can run it.
    The kind is read from pooled deep features and from the parts found: their
    areas, and a small convolution over their coarse map.
Source: residual blocks, He et al. 2016; top-down decoder with skips,
    Lin et al. 2017 (feature pyramid); landmark heatmaps with a soft-argmax
    around the peak, after Nibali et al. 2018.
Cost: see `python net.py`, which prints parameters, multiply-adds and time.
"""
import sys
import time

import torch
import torch.nn as nn
import torch.nn.functional as F

from words import KINDS, LANDMARKS, LIES, PARTS

LIMBS = 4
FLAGS = ["hanger", "flat", "whole"]
OUTPUTS = ["parts", "landmarks", "presence", "kinds", "lies", "flags"]
STRIDE = 4
MEAN, SPREAD = 0.45, 0.25


def conv(a, b, k=3, stride=1, act=True):
    """Convolution, batch norm and, if asked, ReLU."""
    layers = [nn.Conv2d(a, b, k, stride, k // 2, bias=False), nn.BatchNorm2d(b)]
    if act:
        layers.append(nn.ReLU(inplace=True))
    return nn.Sequential(*layers)


class Block(nn.Module):
    """Two 3x3 convolutions added to their input."""

    def __init__(self, width):
        super().__init__()
        self.one = conv(width, width)
        self.two = conv(width, width, act=False)

    def forward(self, x):
        return F.relu(x + self.two(self.one(x)))


def stage(a, b, blocks):
    """One halving of the picture, then residual blocks."""
    return nn.Sequential(conv(a, b, stride=2), *[Block(b) for _ in range(blocks)])


def up(x):
    """Twice the size, bilinear with a fixed factor."""
    return F.interpolate(x, scale_factor=2.0, mode="bilinear", align_corners=False)


def pool(x):
    """Mean over places."""
    return F.adaptive_avg_pool2d(x, 1).flatten(1)


class Net(nn.Module):
    """The whole network; `forward` gives a dict with the names of OUTPUTS."""

    def __init__(self, widths=(16, 32, 64, 96, 112), blocks=(1, 2, 2, 2), decode=(64, 48, 48)):
        super().__init__()
        w, d = widths, decode
        self.stem = conv(3, w[0], stride=2)
        self.stages = nn.ModuleList(stage(w[i], w[i + 1], blocks[i]) for i in range(4))
        self.around = nn.Linear(w[4], d[0])
        self.top = conv(w[4], d[0], 1, act=False)
        self.skips = nn.ModuleList(conv(w[3 - i], d[i], 1, act=False) for i in range(3))
        self.narrow = nn.ModuleList([conv(d[0], d[1], 1, act=False), conv(d[1], d[2], 1, act=False)])
        self.smooth = nn.ModuleList(conv(d[i], d[i]) for i in range(3))
        self.parts = nn.Conv2d(d[2], len(PARTS), 1)
        self.landmarks = nn.Conv2d(d[2], len(LANDMARKS), 1)
        mix = 48
        self.coarse = nn.Sequential(conv(len(PARTS) + d[0], mix, stride=2), conv(mix, mix, stride=2))
        deep = w[4] + mix + len(PARTS)
        self.deep = nn.Sequential(nn.Linear(deep, 128), nn.ReLU(inplace=True), nn.Dropout(0.2))
        self.kinds = nn.Linear(128, len(KINDS))
        self.presence = nn.Linear(128, len(LANDMARKS))
        self.lies = nn.Linear(128, LIMBS * len(LIES))
        self.flags = nn.Linear(128, len(FLAGS))

    def decode(self, levels):
        """Features at strides 16, 8 and 4 from the encoder's levels (shallow first)."""
        x = self.top(levels[4]) + self.around(pool(levels[4]))[:, :, None, None]
        out = []
        for i in range(3):
            if i:
                x = self.narrow[i - 1](x)
            x = self.smooth[i](F.relu(up(x) + self.skips[i](levels[3 - i])))
            out.append(x)
        return out

    def forward(self, picture):
        x = (picture - MEAN) / SPREAD
        levels = [self.stem(x)]
        for part in self.stages:
            levels.append(part(levels[-1]))
        at16, _, at4 = self.decode(levels)
        parts = self.parts(at4)
        share = parts.detach().softmax(1)
        rough = F.avg_pool2d(share, 4)
        coarse = self.coarse(torch.cat([rough, at16], 1))
        deep = self.deep(torch.cat([pool(levels[4]), pool(coarse), pool(share)], 1))
        return {"parts": parts, "landmarks": self.landmarks(at4), "presence": self.presence(deep),
                "kinds": self.kinds(deep), "lies": self.lies(deep), "flags": self.flags(deep)}


def places(heat):
    """Landmark places in 0..1 of the picture, and peak shares, from heat logits [n,20,h,w].

    The share of the 5x5 cells around the highest cell gives a weighted mean.
    """
    n, k, h, w = heat.shape
    share = heat.float().flatten(2).softmax(2)
    at = share.argmax(2)
    row, col = at // w, at % w
    ys = torch.arange(h, device=heat.device)[None, None, :, None]
    xs = torch.arange(w, device=heat.device)[None, None, None, :]
    near = ((ys - row[..., None, None]).abs() <= 2) & ((xs - col[..., None, None]).abs() <= 2)
    part = share.view(n, k, h, w) * near
    total = part.sum((2, 3))
    x = ((xs + 0.5) * part).sum((2, 3)) / total / w
    y = ((ys + 0.5) * part).sum((2, 3)) / total / h
    return torch.stack([x, y], 2), total


def multiply_adds(net, size):
    """Multiply-adds of all convolutions and matrix products for one picture."""
    total, hooks = [0], []

    def count(m, _, out):
        if isinstance(m, nn.Conv2d):
            total[0] += m.weight.numel() * out.shape[2] * out.shape[3]
        else:
            total[0] += m.weight.numel()
    for m in net.modules():
        if isinstance(m, (nn.Conv2d, nn.Linear)):
            hooks.append(m.register_forward_hook(count))
    net(torch.zeros(1, 3, size, size))
    for h in hooks:
        h.remove()
    return total[0]


def main():
    size = int(sys.argv[1]) if len(sys.argv) > 1 else 256
    net = Net().eval()
    with torch.no_grad():
        print(f"parameters {sum(p.numel() for p in net.parameters()):,}")
        print(f"multiply-adds at {size}: {multiply_adds(net, size) / 1e9:.3f} G")
        picture = torch.rand(1, 3, size, size)
        t = time.time()
        for _ in range(10):
            out = net(picture)
        print(f"forward {(time.time() - t) / 10 * 1000:.0f} ms")
    for name, value in out.items():
        print(name, list(value.shape))


if __name__ == "__main__":
    main()

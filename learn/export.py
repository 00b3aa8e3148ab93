"""The trained weights as one ONNX file, and a card that says what they are.

What: writes parts.onnx (one input "picture", outputs named as in net.OUTPUTS,
    batch norms folded into convolutions, height and width free in multiples of
    32) and parts.json (digest, data, seed, commands, figures). Fails when the
    ONNX file and torch differ by more than 1e-3.
Source: ONNX operator set 17; checked with onnx's own reference evaluator.
Cost: under a minute.

    python export.py --weights FILE.pt --out FOLDER [--figures FILE.json]
"""
import argparse
import collections
import hashlib
import json
import os

import numpy as np
import onnx
import torch
import torch.nn as nn
from onnx.reference import ReferenceEvaluator

from net import FLAGS, LIMBS, OUTPUTS, Net
from words import KINDS, LANDMARKS, LIES, PARTS

COMMANDS = ["python draw.py --count 1000 --seed S --size 256 --out POOL/S",
            "python train.py --until HH:MM",
            "python score.py --weights last.pt --json figures.json --sheet sheet.jpg",
            "python export.py --weights last.pt --out . --figures figures.json"]


class Listed(nn.Module):
    """The network with its outputs as a tuple, in the order of OUTPUTS."""

    def __init__(self, net):
        super().__init__()
        self.net = net

    def forward(self, picture):
        out = self.net(picture)
        return tuple(out[k] for k in OUTPUTS)


def fold(net):
    """Batch norms folded into the convolutions before them."""
    for part in net.modules():
        if isinstance(part, nn.Sequential):
            for i in range(len(part) - 1):
                if isinstance(part[i], nn.Conv2d) and isinstance(part[i + 1], nn.BatchNorm2d):
                    part[i] = nn.utils.fusion.fuse_conv_bn_eval(part[i], part[i + 1])
                    part[i + 1] = nn.Identity()
    return net


def write(net, path, size=192):
    """The ONNX file of the folded network."""
    free = {"picture": {2: "height", 3: "width"}, "parts": {2: "rows", 3: "columns"},
            "landmarks": {2: "rows", 3: "columns"}}
    torch.onnx.export(Listed(net).eval(), (torch.rand(1, 3, size, size),), path, dynamo=False,
                      input_names=["picture"], output_names=OUTPUTS, opset_version=17, dynamic_axes=free)
    model = onnx.load(path)
    onnx.checker.check_model(model)
    return model


def difference(net, path, sizes=(128, 192)):
    """Largest difference of any output between torch and the ONNX file."""
    worst, run = 0.0, ReferenceEvaluator(path)
    for size in sizes:
        picture = torch.rand(1, 3, size, size)
        with torch.no_grad():
            want = Listed(net)(picture)
        got = run.run(None, {"picture": picture.numpy()})
        worst = max(worst, *(float(np.abs(a.numpy() - b).max()) for a, b in zip(want, got)))
    return worst


def card(path, model, saved, figures, apart):
    """What the file is, as a dict."""
    with open(path, "rb") as f:
        digest = hashlib.sha256(f.read()).hexdigest()
    return {"file": os.path.basename(path), "sha256": digest, "bytes": os.path.getsize(path),
            "input": "picture [1,3,S,S] float32 RGB 0..1, letterboxed with black, S 128 to 256, a multiple of 32",
            "outputs": {"parts": PARTS, "landmarks": LANDMARKS, "presence": LANDMARKS, "kinds": KINDS,
                        "lies": {"limbs": ["sleeve_left", "sleeve_right", "leg_left", "leg_right"][:LIMBS],
                                 "ways": LIES}, "flags": FLAGS},
            "operations": dict(collections.Counter(n.op_type for n in model.graph.node)),
            "onnx_minus_torch": apart,
            "data": ["clothing-dataset by Alexey Grigorev and senders, CC0 1.0, without the senders kept apart",
                     "drawn pictures of draw.py"],
            "licence": "weights learnt from CC0 photos and drawn pictures only",
            "training": saved.get("about", {}), "figures": figures, "commands": COMMANDS}


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("--weights")
    ask.add_argument("--out", default=".")
    ask.add_argument("--name", default="parts")
    ask.add_argument("--figures")
    a = ask.parse_args()
    torch.manual_seed(0)
    net, saved = Net(), {}
    if a.weights:
        saved = torch.load(a.weights, map_location="cpu", weights_only=False)
        net.load_state_dict(saved["net"])
    net = fold(net.eval())
    os.makedirs(a.out, exist_ok=True)
    path = os.path.join(a.out, a.name + ".onnx")
    model = write(net, path)
    apart = difference(net, path)
    figures = json.load(open(a.figures)) if a.figures else {}
    with open(os.path.join(a.out, a.name + ".json"), "w") as f:
        json.dump(card(path, model, saved, figures, apart), f, indent=1)
    print(f"{path}: {os.path.getsize(path):,} bytes, differs from torch by {apart:.1e}")
    if apart > 1e-3:
        raise SystemExit("the ONNX file differs from torch by more than 1e-3")


if __name__ == "__main__":
    main()

"""Photos of a garment laid flat, or its sewing pattern, in; a sewn and draped 3D garment out.

>>> import toile
>>> r = toile.run("pipelines/pattern.ron", set={"pattern.file": "shirt.json"})
>>> r.garment.positions  # numpy, (n, 3) float64, metres

``run`` runs a pipeline; ``stage`` is one stage alone, or makes a stage of a function. ``verify``,
``batch``, ``manifest``, ``trade`` and ``doctor`` are the commands of that name, with results as
Python objects.
"""

from toile._commands import Batch, CommandOutput, batch, doctor, manifest, trade, verify
from toile._errors import (
    Error,
    Fault,
    InternalError,
    InvalidInputError,
    QualityError,
    StoppedError,
    UsageError,
)
from toile._run import Run, run
from toile._stages import stage
from toile._toile import (
    Artifact,
    Body,
    Garment,
    GarmentPanel,
    Mask,
    Outline,
    Panel,
    Photo,
    StageAlone,
    stage_names,
    version,
)

__version__ = version()

__all__ = [
    "Artifact",
    "Batch",
    "Body",
    "CommandOutput",
    "Error",
    "Fault",
    "Garment",
    "GarmentPanel",
    "InternalError",
    "InvalidInputError",
    "Mask",
    "Outline",
    "Panel",
    "Photo",
    "QualityError",
    "Run",
    "StageAlone",
    "StoppedError",
    "UsageError",
    "__version__",
    "batch",
    "doctor",
    "manifest",
    "run",
    "stage",
    "stage_names",
    "trade",
    "verify",
]

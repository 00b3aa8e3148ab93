"""One stage alone, and functions as stages."""

from __future__ import annotations

import inspect
import json
from collections.abc import Callable, Iterable
from typing import Any, TypeVar, overload

from toile import _toile
from toile._errors import UsageError
from toile._toile import StageAlone
from toile._values import Setting, as_json

_Function = TypeVar("_Function", bound=Callable[..., Any])


@overload
def stage(name: str, /, **parameters: Setting) -> StageAlone: ...


@overload
def stage(
    *,
    role: str,
    name: str | None = None,
    source: str = "",
    version: str = "1",
    contracts: Iterable[str] = ("deterministic",),
) -> Callable[[_Function], _Function]: ...


def stage(*names: str, **options: Any) -> Any:
    """One stage alone: ``toile.stage("Otsu", bias=3)(photo)``; or a function as a stage.

    A stage alone is called with what its ports take, in their order or by name: an artifact, or an
    array for a photo (h, w, 3) or a mask (h, w). A dictionary runs it for each of its values. What
    it warns of is a warning of Python.

    As a decorator, ``@toile.stage(role="Binariser")``, it makes a stage of a function, which then
    stands by its name in pipelines:

    - ``role``: Denoiser (gives a photo), Binariser (a mask), Smoother (positions of a panel), Body
      (vertices and triangles), Draper (positions of a garment) or Writer (paths and bytes).
    - Arguments without a default are what it takes: ``photo`` (h, w, 3) uint8 and ``mask`` (h, w)
      uint8 as arrays, ``panel``, ``garment`` and ``body`` as artifacts.
    - Arguments with a default are its parameters: float, int, bool or str.
    - ``name``: that of the function in CamelCase where none is given.
    - ``version``: results of another version are not taken from the cache. The source of the
      function counts as well; what it reads elsewhere, such as weights, does not: raise the version.
    - ``contracts``: what it promises; ``toile.doctor(name, contracts=True)`` tests it.

    The function itself stays as it is.
    """
    if len(names) == 1:
        return StageAlone(names[0], as_json(options))
    if names or "role" not in options:
        raise UsageError(
            "a stage is named, or made of a function by its role",
            help='write toile.stage("Otsu") or @toile.stage(role="Binariser")',
        )
    return _decorator(**options)


def _decorator(
    *,
    role: str,
    name: str | None = None,
    source: str = "",
    version: str = "1",
    contracts: Iterable[str] = ("deterministic",),
) -> Callable[[_Function], _Function]:
    def of(function: _Function) -> _Function:
        inputs, parameters = _signature(function)
        spec = {
            "name": name or _camel_case(function.__name__),
            "role": role,
            "doc": inspect.getdoc(function) or f"The function {function.__name__} of Python.",
            "source": source,
            "module": function.__module__,
            "content": json.dumps([_source(function), str(version)]),
            "inputs": inputs,
            "parameters": parameters,
            "contracts": list(contracts),
        }
        _toile.define(spec, function)
        return function

    return of


def _camel_case(name: str) -> str:
    return "".join(part[:1].upper() + part[1:] for part in name.split("_"))


def _source(function: Callable[..., Any]) -> str:
    """What makes the function what it is: its source, else its code."""
    try:
        return inspect.getsource(function)
    except (OSError, TypeError):
        code = function.__code__
        return repr((code.co_code, code.co_consts, code.co_names))


def _signature(function: Callable[..., Any]) -> tuple[list[str], list[tuple[str, str, str]]]:
    """What the function takes, and its parameters: names, annotations, defaults as JSON."""
    inputs: list[str] = []
    parameters: list[tuple[str, str, str]] = []
    for parameter in inspect.signature(function).parameters.values():
        if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            raise UsageError(f"a stage cannot take `{parameter}`")
        if parameter.default is parameter.empty:
            if parameter.kind is parameter.KEYWORD_ONLY:
                raise UsageError(
                    f"`{parameter.name}` stands behind `*` and has no default",
                    help="what a stage takes stands before `*`; parameters have a default",
                )
            inputs.append(parameter.name)
            continue
        annotation: Any = parameter.annotation
        if annotation is parameter.empty:
            annotation = type(parameter.default)
        text = annotation if isinstance(annotation, str) else getattr(annotation, "__name__", str(annotation))
        [(_, default)] = as_json({parameter.name: parameter.default})
        parameters.append((parameter.name, text, default))
    return inputs, parameters

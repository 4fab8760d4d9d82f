"""Scenes and traces of FOSSSim: simulate, check, explain, and look at pairs.

Everything has the bits of the program ``fosssim-oracle``: recordings, verdicts, reports and pairs. Lengths, times and
masses have the scene's own units; arrays hold doubles and can't be written.

>>> import fosssim
>>> scene = fosssim.Scene("asset:ContinuousTimeTests/head-on-equal-masses")
>>> trace = fosssim.simulate(scene)
>>> trace.positions.shape == (2 * scene.steps + 1, len(scene.masses), 2)
True
>>> fosssim.check(scene, trace).accepted
True
"""

from __future__ import annotations

import json as _json
import os as _os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from . import _native

__all__ = [
    "Edge",
    "Finding",
    "FosssimError",
    "HalfPlane",
    "Mistake",
    "Pair",
    "Particles",
    "Report",
    "Scene",
    "Trace",
    "check",
    "detect",
    "explain",
    "scenes",
    "simulate",
]

PathLike = Union[str, "_os.PathLike[str]"]


class FosssimError(ValueError):
    """What the program refuses, in the program's words."""


def _ask(*requests: list[bytes], trace: bytes = b"") -> list[list[bytes]]:
    answers = _native.ask(list(requests), trace)
    for answer in answers:
        first = _json.loads(answer[0])
        if isinstance(first, dict) and "error" in first:
            raise FosssimError(first["error"])
    return answers


def _request(what: str, **values: Any) -> bytes:
    return _json.dumps({"do": what, **values}).encode()


def _numbers(data: bytes, *shape: int) -> NDArray[np.float64]:
    """An array that lies where the bytes lie."""
    return np.frombuffer(data, dtype=np.float64).reshape(shape)


def scenes() -> list[str]:
    """The names of the scenes that come with the program, as ``Scene`` takes them."""
    ((listed,),) = _ask([_request("scenes")])
    groups = [group for assignment in _json.loads(listed)["assignments"] for group in assignment["groups"]]
    return [f"asset:{group['group']}/{name}" for group in groups for name in group["names"]]


class Scene:
    """A scene: one that comes with the program (``asset:Group/name``), or a file, or XML.

    A scene that the program's strict reader refuses raises ``FosssimError`` with its messages, line and column.
    """

    #: The scene's name in reports.
    name: str
    #: The XML as it was read.
    xml: bytes
    #: Simulated time, the length of a step, and the number of steps.
    duration: float
    time_step: float
    steps: int
    #: Places and velocities at the start, ``(particles, 2)``.
    positions: NDArray[np.float64]
    velocities: NDArray[np.float64]
    #: Masses and radii, ``(particles,)``.
    masses: NDArray[np.float64]
    radii: NDArray[np.float64]
    #: Whether forces and responses leave a particle alone, ``(particles,)``.
    fixed: NDArray[np.bool_]
    #: The particles at both ends of each edge, ``(edges, 2)``.
    edges: NDArray[np.intp]

    def __init__(self, source: PathLike | None = None, *, xml: str | bytes | None = None) -> None:
        if (source is None) == (xml is None):
            raise TypeError("a scene has a source or its XML, and not both")
        self.name = "scene" if source is None else _os.fspath(source)
        if xml is not None:
            self.xml = xml.encode() if isinstance(xml, str) else bytes(xml)
        elif self.name.startswith("asset:"):
            ((_, self.xml),) = _ask([_request("scene", name=self.name[len("asset:") :])])
        else:
            self.xml = Path(self.name).read_bytes()
        try:
            times, numbers, fixed, edges = _native.scene(self.name, self.xml)
        except ValueError as error:
            raise FosssimError(str(error)) from None
        self.duration, self.time_step, self.steps = times
        positions, velocities, masses, radii = numbers
        self.positions, self.velocities = _numbers(positions, -1, 2), _numbers(velocities, -1, 2)
        self.masses, self.radii = _numbers(masses, -1), _numbers(radii, -1)
        self.fixed = np.frombuffer(fixed, dtype=np.bool_)
        self.edges = np.array(edges, dtype=np.intp).reshape(-1, 2)

    def __repr__(self) -> str:
        return f"<Scene {self.name}: {len(self.masses)} particles, {len(self.edges)} edges, {self.steps} steps>"


class Trace:
    """A trace of a scene: what ``FOSSSim -o`` writes.

    A trace that is damaged or cut holds the records before that place; ``problem`` says what follows.
    """

    #: The scene.
    scene: Scene
    #: The trace's name in reports.
    name: str
    #: The bytes of the file.
    data: bytes
    #: Places and velocities by record, ``(records, particles, 2)``. The first record is the start; how many records a
    #: step has depends on the scene's collision handling.
    positions: NDArray[np.float64]
    velocities: NDArray[np.float64]
    #: Why no more records can be read, if there should be more.
    problem: str | None

    def __init__(self, scene: Scene, source: PathLike | bytes, *, name: str | None = None) -> None:
        self.scene = scene
        if isinstance(source, bytes):
            self.name, self.data = name or "trace", source
        else:
            self.name = name or _os.fspath(source)
            self.data = Path(source).read_bytes()
        positions, velocities, self.problem = _native.states(scene.name, scene.xml, self.data)
        particles = len(scene.masses)
        records = len(positions) // (16 * particles) if particles else 0
        self.positions = _numbers(positions, records, particles, 2)
        self.velocities = _numbers(velocities, records, particles, 2)

    def __len__(self) -> int:
        """The number of records."""
        return len(self.positions)

    def save(self, path: PathLike) -> None:
        """Writes the file that FOSSSim would write."""
        Path(path).write_bytes(self.data)

    def __repr__(self) -> str:
        problem = "" if self.problem is None else f", then: {self.problem}"
        return f"<Trace {self.name} of {self.scene.name}: {len(self)} records{problem}>"


@dataclass(frozen=True)
class Finding:
    """Something in which a trace differs from the reference."""

    #: The step of the first one, and how many there are.
    step: int
    count: int
    #: Its kind, such as ``coefficient`` or ``wrong_normal``, and a sentence about it.
    kind: str
    text: str
    #: All that the JSON report says of it.
    data: dict[str, Any] = field(repr=False)


@dataclass(frozen=True)
class Mistake:
    """A mistake that explains what is wrong."""

    #: Its name in the catalogue, and a sentence.
    key: str
    text: str
    #: Further sentences, which may give a formula away.
    details: list[str]
    #: All that the JSON report says of it.
    data: dict[str, Any] = field(repr=False)


@dataclass(frozen=True)
class Report:
    """What ``fosssim-oracle check`` says of a trace. A notebook shows the page with its viewer."""

    accepted: bool
    #: In words, such as ``wrong answer``, and a sentence.
    verdict: str
    summary: str
    #: Steps that were judged, and the numbers of those that are wrong.
    steps: int
    wrong_steps: list[int]
    findings: list[Finding]
    mistakes: list[Mistake]
    #: The report as ``--format json`` and ``--format html`` write it.
    data: dict[str, Any] = field(repr=False)
    html: str = field(repr=False)

    def _repr_html_(self) -> str:
        page = self.html.replace("&", "&amp;").replace('"', "&quot;")
        return (
            f'<iframe srcdoc="{page}" title="Report" sandbox="allow-scripts allow-downloads"'
            ' style="width: 100%; height: 40em; border: 0"></iframe>'
        )


def simulate(scene: Scene) -> Trace:
    """The reference's trace of a scene, bit for bit that of ``fosssim-oracle simulate``."""
    answers = _ask([_request("simulate", scene=scene.name), scene.xml], [_request("trace")])
    return Trace(scene, answers[1][1], name="reference")


def check(scene: Scene, trace: Trace | PathLike | bytes, *, rules: str = "both") -> Report:
    """Judges a trace by the rule books ``fair``, ``parity`` or ``both``, and explains what is wrong."""
    if not isinstance(trace, Trace):
        trace = Trace(scene, trace)
    request = _request("check", scene=scene.name, trace=trace.name, rules=rules, html=True)
    ((first, text, page),) = _ask([request, scene.xml], trace=trace.data)
    data = _json.loads(text)
    fair = (data.get("fair") or {}).get("findings", [])
    findings = fair if rules == "fair" else data["findings"]
    return Report(
        accepted=_json.loads(first)["accepted"],
        verdict=data["verdict"],
        summary=data["summary"],
        steps=data["steps_judged"],
        wrong_steps=data["wrong_step_numbers"],
        findings=[Finding(f["step"], f["count"], f["kind"], f["text"], f) for f in findings],
        mistakes=[Mistake(m["key"], m["text"], m["details"], m) for m in data["explanations"]],
        data=data,
        html=page.decode(),
    )


def explain(scene: Scene, trace: Trace | PathLike | bytes) -> list[Mistake]:
    """The mistakes that explain what is wrong in a trace; none where it is right."""
    return check(scene, trace).mistakes


Point = Sequence[float]
"""A moving point: place and displacement, ``(x, y, dx, dy)``."""


@dataclass(frozen=True)
class Particles:
    """Two particles."""

    centers: tuple[Point, Point]
    radii: tuple[float, float]


@dataclass(frozen=True)
class Edge:
    """A particle and an edge."""

    center: Point
    ends: tuple[Point, Point]
    radii: tuple[float, float]


@dataclass(frozen=True)
class HalfPlane:
    """A particle and a half-plane."""

    center: Point
    radius: float
    point: tuple[float, float]
    normal: tuple[float, float]


@dataclass(frozen=True)
class Pair:
    """What ``fosssim-oracle detect`` says of a pair. A notebook shows the picture."""

    collides: bool
    #: A sentence.
    decision: str
    #: The report as ``--format text``, ``json`` and ``svg`` write it.
    text: str = field(repr=False)
    data: dict[str, Any] = field(repr=False)
    svg: str = field(repr=False)

    def _repr_html_(self) -> str:
        return self.svg


def detect(pair: Particles | Edge | HalfPlane) -> Pair:
    """Looks at one pair: polynomials, intervals, the decision and the contact's normal."""
    kind = {Particles: "pp", Edge: "pe", HalfPlane: "ph"}[type(pair)]
    values = {name: np.asarray(value, dtype=np.float64).tolist() for name, value in vars(pair).items()}
    ((first, text, data, svg, _),) = _ask([_request("detect", kind=kind, **values)])
    answer = _json.loads(first)
    return Pair(answer["collides"], answer["decision"], text.decode(), _json.loads(data), svg.decode())

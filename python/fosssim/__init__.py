"""Scenes and traces of FOSSSim: simulate, check, explain, and examine pairs.

All results equal those of the program ``fosssim-oracle`` bit for bit: recordings, verdicts, reports and pairs. Lengths,
times and masses have the scene's units. Arrays contain doubles and are read-only.

>>> import fosssim
>>> scene = fosssim.Scene("asset:ContinuousTimeTests/head-on-equal-masses")
>>> trace = fosssim.simulate(scene)
>>> trace.positions.shape == (2 * scene.steps + 1, len(scene.masses), 2)
True
>>> fosssim.check(scene, trace).accepted
True
>>> flawed = fosssim.Trace("asset:ContinuousTimeTests/spinning-edge-sweeps-balls/flawed")
>>> fosssim.explain(flawed.scene, flawed)[0].key
'pe-square-no-eh'

``pandas.DataFrame`` accepts impulses, polynomials and ``table()``.
"""

from __future__ import annotations

import gzip as _gzip
import json as _json
import os as _os
import zlib as _zlib
from dataclasses import dataclass, field
from functools import cached_property
from importlib.metadata import version as _version
from pathlib import Path
from typing import Any, Literal, Sequence, Union, get_args

import numpy as np
from numpy.typing import NDArray

from . import _native

__all__ = [
    "Edge",
    "Error",
    "Finding",
    "Grade",
    "HalfPlane",
    "KINDS",
    "Mistake",
    "Pair",
    "Particles",
    "Report",
    "Scene",
    "Trace",
    "check",
    "detect",
    "explain",
    "grade",
    "scenes",
    "simulate",
]

__version__ = _version("fosssim")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]


PathLike = Union[str, "_os.PathLike[str]"]
Rules = Literal["both", "fair", "parity"]

#: The kinds of pairs, by their number in tables; -1 means no kind.
KINDS = ("particle-particle", "particle-edge", "particle-half-plane")


class Error(ValueError):
    """An error, with the program's message."""


class _Session:
    """A session of requests that are answered one after the other."""

    def __init__(self) -> None:
        self.native = _native.Session()

    def ask(self, what: str, *parts: bytes, file: bytes = b"", **values: Any) -> tuple[Any, list[bytes]]:
        """Sends a request; returns the answer's values and its further parts."""
        first, *rest = self.native.ask([_json.dumps({"do": what, **values}).encode(), *parts], file)
        answer = _json.loads(first)
        if isinstance(answer, dict) and "error" in answer:
            raise Error(answer["error"])
        return answer, rest


def _as_doubles(data: bytes, *shape: int) -> NDArray[np.float64]:
    """Returns an array that shares the memory of the bytes."""
    return np.frombuffer(data, dtype=np.float64).reshape(shape)


def scenes() -> list[str]:
    """Returns the names of the built-in scenes, in the form for ``Scene``."""
    answer, _ = _Session().ask("scenes")
    groups = [group for assignment in answer["assignments"] for group in assignment["groups"]]
    return [f"asset:{group['group']}/{name}" for group in groups for name in group["names"]]


class Scene:
    """A scene: a built-in one (``asset:Group/name``), a file, or XML.

    A scene that the program's strict reader rejects raises ``Error`` with its messages, line and column.
    """

    #: The scene's name in reports.
    name: str
    #: The XML of the scene, unchanged.
    xml: bytes
    #: The simulated time, the length of a step, and the number of steps.
    duration: float
    time_step: float
    steps: int
    #: The positions and velocities at the start, ``(particles, 2)``.
    positions: NDArray[np.float64]
    velocities: NDArray[np.float64]
    #: The masses and radii of the particles, ``(particles,)``.
    masses: NDArray[np.float64]
    radii: NDArray[np.float64]
    #: Whether each particle is fixed, so that forces and responses do not move it, ``(particles,)``.
    fixed: NDArray[np.bool_]
    #: The particles at both ends of each edge, ``(edges, 2)``.
    edges: NDArray[np.intp]

    def __init__(self, source: PathLike | None = None, *, xml: str | bytes | None = None) -> None:
        if (source is None) == (xml is None):
            raise TypeError("a scene needs either a source or its XML")
        self.name = "scene" if source is None else _os.fspath(source)
        if xml is not None:
            self.xml = xml.encode() if isinstance(xml, str) else bytes(xml)
        elif self.name.startswith("asset:"):
            _, (self.xml,) = _Session().ask("scene", name=self.name[len("asset:") :])
        else:
            self.xml = Path(self.name).read_bytes()
        try:
            times, numbers, fixed, edges = _native.scene(self.name, self.xml)
        except ValueError as error:
            raise Error(str(error)) from None
        self.duration, self.time_step, self.steps, self._records_per_step = times
        positions, velocities, masses, radii = numbers
        self.positions, self.velocities = _as_doubles(positions, -1, 2), _as_doubles(velocities, -1, 2)
        self.masses, self.radii = _as_doubles(masses, -1), _as_doubles(radii, -1)
        self.fixed = np.frombuffer(fixed, dtype=np.bool_)
        self.edges = np.array(edges, dtype=np.intp).reshape(-1, 2)

    def __repr__(self) -> str:
        counts = {"particle": len(self.masses), "edge": len(self.edges), "step": self.steps}
        words = ", ".join(f"{count} {noun}{'s' * (count != 1)}" for noun, count in counts.items())
        return f"<Scene {self.name}: {words}>"


SceneLike = Union[Scene, PathLike]
"""A scene, or the name of a scene."""


def _load_scene(scene: SceneLike) -> Scene:
    return scene if isinstance(scene, Scene) else Scene(scene)


_LOCATION = [("record", np.int64), ("step", np.int64), ("kind", np.int32), ("first", np.int32), ("second", np.int32)]
_IMPULSE = np.dtype([*_LOCATION, ("normal_x", np.float64), ("normal_y", np.float64), ("time", np.float64)])
_POLYNOMIAL = np.dtype([*_LOCATION, ("number", np.int32), ("start", np.int64), ("size", np.int64)])


class Trace:
    """A trace of a scene: the output of ``FOSSSim -o``, plain or compressed with gzip.

    If a trace is damaged or cut short, it contains the records before the damage, and ``problem`` describes it.
    ``asset:Group/name`` is the scene's recording, and ``asset:Group/name/flawed`` is a built-in wrong trace.
    """

    #: The scene that the trace belongs to.
    scene: Scene
    #: The trace's name in reports.
    name: str
    #: The decompressed bytes of the trace.
    data: bytes
    #: The positions and velocities by record, ``(records, particles, 2)``. The first record is the start. The number of
    #: records per step depends on the scene's collision handling.
    positions: NDArray[np.float64]
    velocities: NDArray[np.float64]
    #: The reason why no more records can be read, if some are missing.
    problem: str | None

    def __init__(self, scene: SceneLike, source: PathLike | bytes | None = None, *, name: str | None = None) -> None:
        if source is None:
            # The name contains the scene's.
            source = _os.fspath(scene.name if isinstance(scene, Scene) else scene)
            if not source.startswith("asset:"):
                raise TypeError("a trace needs a scene and a source")
            scene = source[: -len("/flawed")] if source.endswith("/flawed") else source
        self.scene = scene = _load_scene(scene)
        self.name = name or ("trace" if isinstance(source, bytes) else _os.fspath(source))
        self.data = _read_trace(source)
        positions, velocities, self.problem = _native.states(scene.name, scene.xml, self.data)
        particles = len(scene.masses)
        records = len(positions) // (16 * particles) if particles else 0
        self.positions = _as_doubles(positions, records, particles, 2)
        self.velocities = _as_doubles(velocities, records, particles, 2)

    def __len__(self) -> int:
        """Returns the number of records."""
        return len(self.positions)

    @property
    def steps(self) -> NDArray[np.int64]:
        """The step of each record; 0 is the start."""
        per_step = self.scene._records_per_step
        return (np.arange(len(self), dtype=np.int64) + per_step - 1) // per_step

    @property
    def times(self) -> NDArray[np.float64]:
        """The simulated time at the end of each record's step."""
        return self.steps * np.float64(self.scene.time_step)

    @cached_property
    def _logs(self) -> list[bytes]:
        return _native.logs(self.scene.name, self.scene.xml, self.data)

    @property
    def impulses(self) -> NDArray[np.void]:
        """The impulses of all records, with their contacts.

        A row has: ``record``, ``step``, ``kind`` (see ``KINDS``), the objects ``first`` and ``second``, the contact
        normal ``normal_x``, ``normal_y``, and the ``time`` of impact as a fraction of the step.
        """
        return np.frombuffer(self._logs[0], dtype=_IMPULSE)

    @property
    def polynomials(self) -> NDArray[np.void]:
        """The polynomials of all records; their coefficients are in ``coefficients``.

        A row has: ``record``, ``step``, the pair (``kind``, ``first``, ``second``), the ``number`` of the polynomial in
        the pair, and the ``start`` and ``size`` of its coefficients. A trace does not name pairs, so they are those
        that the reference tests in the step, or -1 for surplus polynomials of the trace.
        """
        return np.frombuffer(self._logs[1], dtype=_POLYNOMIAL)

    @property
    def coefficients(self) -> NDArray[np.float64]:
        """The coefficients of all polynomials, the highest power first, as ``numpy.polyval`` expects."""
        return _as_doubles(self._logs[2], -1)

    def polynomial(self, row: int) -> NDArray[np.float64]:
        """Returns the coefficients of one row of ``polynomials``."""
        start, size = self.polynomials[row][["start", "size"]].item()
        return self.coefficients[start : start + size]

    def table(self) -> dict[str, NDArray[Any]]:
        """Returns columns for ``pandas.DataFrame`` or ``pyarrow.table``, with a row for each record and particle."""
        records, particles = self.positions.shape[:2]
        columns = {"record": np.arange(records), "step": self.steps, "time": self.times}
        return {
            **{name: np.repeat(column, particles) for name, column in columns.items()},
            "particle": np.tile(np.arange(particles), records),
            **{name: self.positions[..., axis].ravel() for axis, name in enumerate("xy")},
            **{name: self.velocities[..., axis].ravel() for axis, name in enumerate(["vx", "vy"])},
        }

    def save(self, path: PathLike) -> None:
        """Writes the trace to a file, in the format of FOSSSim."""
        Path(path).write_bytes(self.data)

    def __repr__(self) -> str:
        problem = "" if self.problem is None else f", then: {self.problem}"
        return f"<Trace {self.name} of {self.scene.name}: {len(self)} records{problem}>"


@dataclass(frozen=True)
class Finding:
    """A kind of difference between a trace and the reference."""

    #: The step of the first difference, and the number of differences.
    step: int
    count: int
    #: The kind, such as ``coefficient`` or ``wrong_normal``, and a sentence about the first one.
    kind: str
    text: str
    #: The finding in the JSON report.
    data: dict[str, Any] = field(repr=False)


@dataclass(frozen=True)
class Mistake:
    """A mistake that explains the faults of a trace."""

    #: The name in the catalog, and a sentence about the mistake.
    key: str
    text: str
    #: Further sentences, which may give a formula away.
    details: list[str]
    #: The explanation in the JSON report.
    data: dict[str, Any] = field(repr=False)


@dataclass(frozen=True)
class Report:
    """The report of ``fosssim-oracle check`` on a trace. A notebook shows it as a page with a viewer."""

    accepted: bool
    #: The verdict, such as ``wrong answer``, and a sentence about it.
    verdict: str
    summary: str
    #: The number of judged steps, and the numbers of the wrong ones.
    steps: int
    wrong_steps: list[int] = field(repr=False)
    findings: list[Finding]
    mistakes: list[Mistake]
    #: The report in the form of ``--format json``, and the trace.
    data: dict[str, Any] = field(repr=False)
    trace: Trace = field(repr=False)
    rules: Rules = field(repr=False)

    @cached_property
    def html(self) -> str:
        """The report in the form of ``--format html``, which is created when it is first read."""
        return _check(self.trace, self.rules, html=True)[1][1].decode()

    def _repr_html_(self) -> str:
        page = self.html.replace("&", "&amp;").replace('"', "&quot;")
        return (
            f'<iframe srcdoc="{page}" title="Report" sandbox="allow-scripts allow-downloads"'
            ' style="width: 100%; height: 40em; border: 0"></iframe>'
        )


def _read_trace(source: PathLike | bytes) -> bytes:
    """Returns the decompressed bytes of a trace."""
    name = "" if isinstance(source, bytes) else _os.fspath(source)
    if name.startswith("asset:"):
        scene, _, flawed = name.partition("/flawed")
        if not flawed and scene != name:
            example, (trace,) = _Session().ask("example")
            if f"asset:{example['scene']}" == scene:
                return trace
            raise Error(f"{scene} has no built-in wrong trace; use asset:{example['scene']}/flawed")
        return simulate(name).data
    data = source if isinstance(source, bytes) else Path(name).read_bytes()
    try:
        return _gzip.decompress(data) if data.startswith(b"\x1f\x8b") else data
    except (EOFError, OSError, _zlib.error) as error:
        raise Error(f"{name or 'the trace'}: {error}") from None


def simulate(scene: SceneLike) -> Trace:
    """Simulates a scene; returns the same trace as ``fosssim-oracle simulate``, bit for bit."""
    scene, session = _load_scene(scene), _Session()
    session.ask("simulate", scene.xml, scene=scene.name)
    _, (trace,) = session.ask("trace")
    return Trace(scene, trace, name="reference")


def _check(trace: Trace, rules: Rules, *, html: bool) -> tuple[Any, list[bytes]]:
    scene = trace.scene
    values = {"scene": scene.name, "trace": trace.name, "rules": rules, "html": html}
    return _Session().ask("check", scene.xml, file=trace.data, **values)


def _resolve_trace(scene: SceneLike | Trace, trace: Trace | PathLike | bytes | None) -> Trace:
    if isinstance(scene, Trace):
        return scene
    return trace if isinstance(trace, Trace) else Trace(scene, trace)


def check(
    scene: SceneLike | Trace, trace: Trace | PathLike | bytes | None = None, *, rules: Rules = "both"
) -> Report:
    """Judges a trace by the rule books ``fair``, ``parity`` or ``both``, and explains its faults.

    The scene alone is sufficient if it is a :class:`Trace`, or the name of a built-in trace.
    """
    if rules not in get_args(Rules):
        raise Error(f"rules must be both, fair or parity, not {rules!r}")
    trace = _resolve_trace(scene, trace)
    first, (text,) = _check(trace, rules, html=False)
    data = _json.loads(text)
    fair = (data.get("fair") or {}).get("findings", [])
    findings = fair if rules == "fair" else data["findings"]
    return Report(
        accepted=first["accepted"],
        verdict=data["verdict"],
        summary=data["summary"],
        steps=data["steps_judged"],
        wrong_steps=data["wrong_step_numbers"],
        findings=[Finding(f["step"], f["count"], f["kind"], f["text"], f) for f in findings],
        mistakes=[Mistake(m["key"], m["text"], m["details"], m) for m in data["explanations"]],
        data=data,
        trace=trace,
        rules=rules,
    )


def explain(scene: SceneLike | Trace, trace: Trace | PathLike | bytes | None = None) -> list[Mistake]:
    """Returns the mistakes that explain the faults of a trace; empty if it is right."""
    return check(scene, trace).mistakes


@dataclass(frozen=True)
class Grade:
    """The grade of a submission's traces."""

    name: str
    suite: str
    #: The verdict, such as ``wrong answer``.
    verdict: str
    points: float
    max_points: float
    #: Columns for ``pandas.DataFrame``, a row for each scene: group, scene, verdict, points and the likely mistake.
    table: dict[str, list[Any]] = field(repr=False)
    #: The grade in the form of ``grade --traces --format json``.
    data: dict[str, Any] = field(repr=False)


def grade(folder: PathLike, suite: PathLike | None = None, *, student: bool = False) -> Grade:
    """Grades a folder of traces, ``Group/name.bin`` or ``name.bin``, like ``fosssim-oracle grade --traces``.

    The suite is a built-in one, such as ``t1m3``, or a file, whose scenes are in the same folder.
    With ``student``, parts that the suite's hints hide are left out.
    """
    folder, session = Path(folder), _Session()
    parts: list[bytes] = []
    values: dict[str, Any] = {"is_for_students": student}
    if suite is not None and Path(suite).suffix == ".toml":
        scene_files = sorted(Path(suite).parent.rglob("*.xml"))
        parts = [Path(suite).read_bytes(), *(scene.read_bytes() for scene in scene_files)]
        values["scenes"] = [scene.relative_to(Path(suite).parent).as_posix() for scene in scene_files]
    elif suite is not None:
        values["suite"] = _os.fspath(suite)
    if not folder.is_dir():
        raise Error(f"{folder} is not a folder of traces: a trace is Group/name.bin in it")
    suite_answer, _ = session.ask("suite", *parts, **values)
    columns = ("group", "scene", "verdict", "points", "max_points", "likely")
    table: dict[str, list[Any]] = {name: [] for name in columns}
    scenes = [(group["name"], scene) for group in suite_answer["groups"] for scene in group["scenes"]]
    files = []
    for _, scene in scenes:
        names = [f"{name}.bin{suffix}" for name in (scene, scene.split("/")[-1]) for suffix in ("", ".zst", ".gz")]
        files.append(next((folder / name for name in names if (folder / name).is_file()), None))
    if not any(files):
        raise Error(f"{folder} contains no trace of a scene of the suite: a trace is Group/name.bin in it")
    for number, ((group, scene), file) in enumerate(zip(scenes, files)):
        trace = b"" if file is None else _read_trace(file)
        result, _ = session.ask("judge", number=number, has_trace=file is not None, file=trace)
        for name, value in (("group", group), ("scene", scene), ("verdict", result["verdict"])):
            table[name].append(value)
    graded, (data,) = session.ask("grade", name=folder.name)
    table["likely"] = [scene["likely"] for scene in graded["scenes"]]
    table["points"] = [float(scene["points"]) for scene in graded["scenes"]]
    table["max_points"] = [float(scene["of"]) for scene in graded["scenes"]]
    points, max_points = float(graded["points"]), float(graded["of"])
    return Grade(folder.name, suite_answer["suite"], graded["verdict"], points, max_points, table, _json.loads(data))


Point = Sequence[float]
"""A moving point: position and displacement, ``(x, y, dx, dy)``."""


@dataclass(frozen=True)
class Particles:
    """A pair of two particles."""

    centers: tuple[Point, Point]
    radii: tuple[float, float]


@dataclass(frozen=True)
class Edge:
    """A pair of a particle and an edge."""

    center: Point
    ends: tuple[Point, Point]
    radii: tuple[float, float]


@dataclass(frozen=True)
class HalfPlane:
    """A pair of a particle and a half-plane."""

    center: Point
    radius: float
    point: tuple[float, float]
    normal: tuple[float, float]


@dataclass(frozen=True)
class Pair:
    """The report of ``fosssim-oracle detect`` on a pair. A notebook shows its picture."""

    collides: bool
    #: The decision as a sentence.
    decision: str
    #: The report in the forms of ``--format text``, ``json`` and ``svg``.
    text: str = field(repr=False)
    data: dict[str, Any] = field(repr=False)
    svg: str = field(repr=False)

    def _repr_html_(self) -> str:
        return self.svg


def detect(pair: Particles | Edge | HalfPlane) -> Pair:
    """Computes one pair: polynomials, intervals, the decision and the contact's normal."""
    kind = {Particles: "pp", Edge: "pe", HalfPlane: "ph"}.get(type(pair))
    if kind is None:
        raise TypeError(f"a pair must be Particles, an Edge or a HalfPlane, not {type(pair).__name__}")
    values = {name: np.asarray(value, dtype=np.float64).tolist() for name, value in vars(pair).items()}
    answer, (text, data, svg, _) = _Session().ask("detect", kind=kind, **values)
    return Pair(answer["collides"], answer["decision"], text.decode(), _json.loads(data), svg.decode())

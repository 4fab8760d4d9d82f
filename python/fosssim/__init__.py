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
>>> flawed = fosssim.Trace("asset:ContinuousTimeTests/spinning-edge-sweeps-balls/flawed")
>>> fosssim.explain(flawed.scene, flawed)[0].key
'pe-square-no-eh'

Impulses, polynomials and ``table()`` are what ``pandas.DataFrame`` takes.
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

#: Kinds of pairs by their number in tables; -1 is none.
KINDS = ("particle-particle", "particle-edge", "particle-half-plane")


class Error(ValueError):
    """What the program refuses, in the program's words."""


class _Session:
    """Requests that are answered one after the other."""

    def __init__(self) -> None:
        self.native = _native.Session()

    def ask(self, what: str, *parts: bytes, file: bytes = b"", **values: Any) -> tuple[Any, list[bytes]]:
        """The answer's values, and its further parts."""
        first, *rest = self.native.ask([_json.dumps({"do": what, **values}).encode(), *parts], file)
        answer = _json.loads(first)
        if isinstance(answer, dict) and "error" in answer:
            raise Error(answer["error"])
        return answer, rest


def _numbers(data: bytes, *shape: int) -> NDArray[np.float64]:
    """An array that lies where the bytes lie."""
    return np.frombuffer(data, dtype=np.float64).reshape(shape)


def scenes() -> list[str]:
    """The names of the scenes that come with the program, as ``Scene`` takes them."""
    listed, _ = _Session().ask("scenes")
    groups = [group for assignment in listed["assignments"] for group in assignment["groups"]]
    return [f"asset:{group['group']}/{name}" for group in groups for name in group["names"]]


class Scene:
    """A scene: one that comes with the program (``asset:Group/name``), or a file, or XML.

    A scene that the program's strict reader refuses raises ``Error`` with its messages, line and column.
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
            _, (self.xml,) = _Session().ask("scene", name=self.name[len("asset:") :])
        else:
            self.xml = Path(self.name).read_bytes()
        try:
            times, numbers, fixed, edges = _native.scene(self.name, self.xml)
        except ValueError as error:
            raise Error(str(error)) from None
        self.duration, self.time_step, self.steps, self._records_per_step = times
        positions, velocities, masses, radii = numbers
        self.positions, self.velocities = _numbers(positions, -1, 2), _numbers(velocities, -1, 2)
        self.masses, self.radii = _numbers(masses, -1), _numbers(radii, -1)
        self.fixed = np.frombuffer(fixed, dtype=np.bool_)
        self.edges = np.array(edges, dtype=np.intp).reshape(-1, 2)

    def __repr__(self) -> str:
        return f"<Scene {self.name}: {len(self.masses)} particles, {len(self.edges)} edges, {self.steps} steps>"


SceneLike = Union[Scene, PathLike]
"""A scene, or the name of one."""


def _scene(scene: SceneLike) -> Scene:
    return scene if isinstance(scene, Scene) else Scene(scene)


_PLACE = [("record", np.int64), ("step", np.int64), ("kind", np.int32), ("first", np.int32), ("second", np.int32)]
_IMPULSE = np.dtype([*_PLACE, ("normal_x", np.float64), ("normal_y", np.float64), ("time", np.float64)])
_POLYNOMIAL = np.dtype([*_PLACE, ("number", np.int32), ("start", np.int64), ("size", np.int64)])


class Trace:
    """A trace of a scene: what ``FOSSSim -o`` writes, as it is or packed by gzip.

    A trace that is damaged or cut holds the records before that place; ``problem`` says what follows.
    ``asset:Group/name`` is the scene's recording, and ``asset:Group/name/flawed`` the wrong trace that comes with one.
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

    def __init__(self, scene: SceneLike, source: PathLike | bytes | None = None, *, name: str | None = None) -> None:
        if source is None:
            # Its name tells the scene.
            source = _os.fspath(scene.name if isinstance(scene, Scene) else scene)
            if not source.startswith("asset:"):
                raise TypeError("a trace has a scene and a source")
            scene = source[: -len("/flawed")] if source.endswith("/flawed") else source
        self.scene = scene = _scene(scene)
        self.name = name or ("trace" if isinstance(source, bytes) else _os.fspath(source))
        self.data = _trace(source)
        positions, velocities, self.problem = _native.states(scene.name, scene.xml, self.data)
        particles = len(scene.masses)
        records = len(positions) // (16 * particles) if particles else 0
        self.positions = _numbers(positions, records, particles, 2)
        self.velocities = _numbers(velocities, records, particles, 2)

    def __len__(self) -> int:
        """The number of records."""
        return len(self.positions)

    @property
    def steps(self) -> NDArray[np.int64]:
        """The step of each record; 0 is the start."""
        per_step = self.scene._records_per_step
        return (np.arange(len(self), dtype=np.int64) + per_step - 1) // per_step

    @property
    def times(self) -> NDArray[np.float64]:
        """The simulated time of each record: that of its step's end."""
        return self.steps * np.float64(self.scene.time_step)

    @cached_property
    def _logs(self) -> list[bytes]:
        return _native.logs(self.scene.name, self.scene.xml, self.data)

    @property
    def impulses(self) -> NDArray[np.void]:
        """The impulses of all records, with their contacts.

        One row each: ``record``, ``step``, ``kind`` (see ``KINDS``), the objects ``first`` and ``second``, the contact
        normal ``normal_x``, ``normal_y``, and the ``time`` of impact as a fraction of the step.
        """
        return np.frombuffer(self._logs[0], dtype=_IMPULSE)

    @property
    def polynomials(self) -> NDArray[np.void]:
        """The polynomials of all records, of which ``coefficients`` has the numbers.

        One row each: ``record``, ``step``, the pair (``kind``, ``first``, ``second``), which ``number`` of the pair's it
        is, and the ``start`` and ``size`` of its coefficients. A trace does not name pairs: they are those that the
        reference tests in this step, and -1 where the trace has more polynomials.
        """
        return np.frombuffer(self._logs[1], dtype=_POLYNOMIAL)

    @property
    def coefficients(self) -> NDArray[np.float64]:
        """The coefficients of all polynomials, the highest power first, as ``numpy.polyval`` takes them."""
        return _numbers(self._logs[2], -1)

    def polynomial(self, row: int) -> NDArray[np.float64]:
        """The coefficients of one row of ``polynomials``."""
        start, size = self.polynomials[row][["start", "size"]].item()
        return self.coefficients[start : start + size]

    def table(self) -> dict[str, NDArray[Any]]:
        """Columns for ``pandas.DataFrame``, ``pyarrow.table`` and the like: a row for each record and particle."""
        records, particles = self.positions.shape[:2]
        columns = {"record": np.arange(records), "step": self.steps, "time": self.times}
        return {
            **{name: np.repeat(column, particles) for name, column in columns.items()},
            "particle": np.tile(np.arange(particles), records),
            **{name: self.positions[..., axis].ravel() for axis, name in enumerate("xy")},
            **{name: self.velocities[..., axis].ravel() for axis, name in enumerate(["vx", "vy"])},
        }

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
    #: The report as ``--format json`` writes it, and the trace.
    data: dict[str, Any] = field(repr=False)
    trace: Trace = field(repr=False)
    rules: Rules = field(repr=False)

    @cached_property
    def html(self) -> str:
        """The report as ``--format html`` writes it; it is made when it is asked for."""
        return _check(self.trace, self.rules, html=True)[1][1].decode()

    def _repr_html_(self) -> str:
        page = self.html.replace("&", "&amp;").replace('"', "&quot;")
        return (
            f'<iframe srcdoc="{page}" title="Report" sandbox="allow-scripts allow-downloads"'
            ' style="width: 100%; height: 40em; border: 0"></iframe>'
        )


def _trace(source: PathLike | bytes) -> bytes:
    """The bytes of a trace."""
    name = "" if isinstance(source, bytes) else _os.fspath(source)
    if name.startswith("asset:"):
        scene, _, flawed = name.partition("/flawed")
        if not flawed and scene != name:
            example, (trace,) = _Session().ask("example")
            if f"asset:{example['scene']}" == scene:
                return trace
            raise Error(f"no wrong trace comes with {scene}; asset:{example['scene']}/flawed is there")
        return simulate(name).data
    data = source if isinstance(source, bytes) else Path(name).read_bytes()
    try:
        return _gzip.decompress(data) if data.startswith(b"\x1f\x8b") else data
    except (EOFError, OSError, _zlib.error) as error:
        raise Error(f"{name or 'the trace'}: {error}") from None


def simulate(scene: SceneLike) -> Trace:
    """The reference's trace of a scene, bit for bit that of ``fosssim-oracle simulate``."""
    scene, session = _scene(scene), _Session()
    session.ask("simulate", scene.xml, scene=scene.name)
    _, (trace,) = session.ask("trace")
    return Trace(scene, trace, name="reference")


def _check(trace: Trace, rules: Rules, *, html: bool) -> tuple[Any, list[bytes]]:
    scene = trace.scene
    values = {"scene": scene.name, "trace": trace.name, "rules": rules, "html": html}
    return _Session().ask("check", scene.xml, file=trace.data, **values)


def _traced(scene: SceneLike | Trace, trace: Trace | PathLike | bytes | None) -> Trace:
    if isinstance(scene, Trace):
        return scene
    return trace if isinstance(trace, Trace) else Trace(scene, trace)


def check(
    scene: SceneLike | Trace, trace: Trace | PathLike | bytes | None = None, *, rules: Rules = "both"
) -> Report:
    """Judges a trace by the rule books ``fair``, ``parity`` or ``both``, and explains what is wrong.

    A :class:`Trace` knows its scene, and so does the name of a trace that comes with the module.
    """
    if rules not in get_args(Rules):
        raise Error(f"rules must be both, fair or parity, not {rules!r}")
    trace = _traced(scene, trace)
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
    """The mistakes that explain what is wrong in a trace; none where it is right."""
    return check(scene, trace).mistakes


@dataclass(frozen=True)
class Grade:
    """Points for a submission's traces."""

    name: str
    suite: str
    #: In words, such as ``wrong answer``.
    verdict: str
    points: float
    max_points: float
    #: Columns for ``pandas.DataFrame``, a row for each scene: group, scene, verdict, points and the likely mistake.
    table: dict[str, list[Any]] = field(repr=False)
    #: The grade as ``grade --traces --format json`` writes it.
    data: dict[str, Any] = field(repr=False)


def grade(folder: PathLike, suite: PathLike | None = None, *, student: bool = False) -> Grade:
    """Grades a folder of traces, ``Group/name.bin`` or ``name.bin``, as ``fosssim-oracle grade --traces`` does.

    The suite is one that comes with the program, such as ``t1m3``, or a file; its scenes are then looked for beside it.
    For a student it leaves out what the suite's hints keep back.
    """
    folder, session = Path(folder), _Session()
    parts: list[bytes] = []
    values: dict[str, Any] = {"is_for_students": student}
    if suite is not None and Path(suite).suffix == ".toml":
        beside = sorted(Path(suite).parent.rglob("*.xml"))
        parts = [Path(suite).read_bytes(), *(scene.read_bytes() for scene in beside)]
        values["scenes"] = [scene.relative_to(Path(suite).parent).as_posix() for scene in beside]
    elif suite is not None:
        values["suite"] = _os.fspath(suite)
    if not folder.is_dir():
        raise Error(f"{folder} is not a folder of traces: a trace is Group/name.bin in it")
    begun, _ = session.ask("suite", *parts, **values)
    columns = ("group", "scene", "verdict", "points", "max_points", "likely")
    table: dict[str, list[Any]] = {name: [] for name in columns}
    scenes = [(group["name"], scene) for group in begun["groups"] for scene in group["scenes"]]
    for number, (group, scene) in enumerate(scenes):
        names = [f"{name}.bin{packed}" for name in (scene, scene.split("/")[-1]) for packed in ("", ".zst", ".gz")]
        found = next((folder / name for name in names if (folder / name).is_file()), None)
        trace = b"" if found is None else _trace(found)
        judged, _ = session.ask("judge", number=number, has_trace=found is not None, file=trace)
        for name, value in (("group", group), ("scene", scene), ("verdict", judged["verdict"])):
            table[name].append(value)
    whole, (data,) = session.ask("grade", name=folder.name)
    table["likely"] = [scene["likely"] for scene in whole["scenes"]]
    table["points"] = [float(scene["points"]) for scene in whole["scenes"]]
    table["max_points"] = [float(scene["of"]) for scene in whole["scenes"]]
    points, of = float(whole["points"]), float(whole["of"])
    return Grade(folder.name, begun["suite"], whole["verdict"], points, of, table, _json.loads(data))


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
    kind = {Particles: "pp", Edge: "pe", HalfPlane: "ph"}.get(type(pair))
    if kind is None:
        raise TypeError(f"a pair is Particles, an Edge or a HalfPlane, not {type(pair).__name__}")
    values = {name: np.asarray(value, dtype=np.float64).tolist() for name, value in vars(pair).items()}
    answer, (text, data, svg, _) = _Session().ask("detect", kind=kind, **values)
    return Pair(answer["collides"], answer["decision"], text.decode(), _json.loads(data), svg.decode())

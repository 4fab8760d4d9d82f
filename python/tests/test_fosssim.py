"""The module as people use it: the wheel, installed, beside the repository's examples."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import fosssim

ROOT = Path(__file__).resolve().parents[2]
SCENE = "asset:ContinuousTimeTests/spinning-edge-sweeps-balls"
FLAWED = f"{SCENE}/flawed"


def program(*arguments: str) -> bytes:
    """What the program prints, for comparison."""
    path = os.environ.get("FOSSSIM_ORACLE") or shutil.which("fosssim-oracle")
    if path is None:
        pytest.skip("no fosssim-oracle to compare with: FOSSSIM_ORACLE names it")
    return subprocess.run([path, *arguments], capture_output=True, cwd=ROOT).stdout


def test_every_scene_inside_can_be_read():
    names = fosssim.scenes()
    assert len(names) > 100 and SCENE in names
    for name in names:
        scene = fosssim.Scene(name)
        assert scene.positions.shape == scene.velocities.shape == (len(scene.masses), 2)
        assert scene.radii.shape == scene.fixed.shape == scene.masses.shape
        assert scene.edges.size == 0 or scene.edges.max() < len(scene.masses)


def test_a_reference_is_accepted_and_its_arrays_lie_in_its_bytes():
    scene = fosssim.Scene(SCENE)
    trace = fosssim.simulate(scene)
    assert trace.problem is None and trace.positions.shape[1:] == (len(scene.masses), 2)
    assert np.array_equal(trace.positions[0], scene.positions)
    assert not trace.positions.flags.owndata and not trace.positions.flags.writeable
    report = fosssim.check(scene, trace)
    assert report.accepted and not report.wrong_steps and not report.mistakes and not report.findings


def test_a_wrong_trace_has_its_mistake_by_name():
    scene = fosssim.Scene(SCENE)
    report = fosssim.check(SCENE, FLAWED)
    # A trace knows its scene, and so does a trace that comes with the module.
    assert fosssim.check(FLAWED).data == fosssim.check(fosssim.Trace(FLAWED)).data == report.data
    assert fosssim.explain(FLAWED) == report.mistakes
    assert set(dir(fosssim)) == {*fosssim.__all__, "__version__"}
    assert not report.accepted and report.verdict == "wrong answer"
    assert report.steps == 24 and report.wrong_steps[0] == 2 and len(report.wrong_steps) == 23
    assert len(repr(report)) < 2000, "a notebook shows it whole"
    assert report.findings[0].count > 0 and "particle 2" in report.findings[0].text
    assert [mistake.key for mistake in fosssim.explain(scene, FLAWED)] == ["pe-square-no-eh"]
    assert report._repr_html_().startswith("<iframe srcdoc=")


def test_reports_and_recordings_are_those_of_the_program(tmp_path):
    written = tmp_path / "reference.bin"
    program("simulate", SCENE, "--output", str(written))
    assert fosssim.simulate(fosssim.Scene(SCENE)).data == written.read_bytes()
    printed = json.loads(program("check", SCENE, FLAWED, "--format", "json"))
    report = fosssim.check(SCENE, fosssim.Trace(FLAWED))
    assert report.data == printed
    assert report.html.encode() == program("check", SCENE, FLAWED, "--format", "html")


def test_logs_are_arrays_and_tables():
    trace = fosssim.Trace(FLAWED)
    assert np.array_equal(trace.times, trace.steps * trace.scene.time_step) and trace.steps[-1] == trace.scene.steps
    polynomials = pd.DataFrame(trace.polynomials)
    # Two for a pair of particles, four for a particle and an edge, in every pass.
    of_pairs = polynomials.groupby(["record", "kind"]).size()
    assert of_pairs[1, 0] % 12 == 0 and of_pairs[1, 1] % 8 == 0 and len(of_pairs) == 2 * 2 * trace.scene.steps
    assert polynomials["size"].sum() == len(trace.coefficients)
    assert len(trace.polynomial(0)) == polynomials["size"][0]
    impulses = pd.DataFrame(trace.impulses)
    assert impulses.loc[0, ["record", "step", "kind", "first", "second"]].tolist() == [17, 9, 1, 2, 0]
    shown = json.loads(program("trace", "show", SCENE, FLAWED, "--step", "9", "--format", "json"))
    assert impulses["time"][0] == shown["records"][0]["impulses"][0]["time"]
    table = pd.DataFrame(trace.table())
    assert np.array_equal(table[table["particle"] == 2]["vy"], trace.velocities[:, 2, 1])


def test_a_folder_of_traces_has_a_grade(tmp_path):
    names = [name[len("asset:") :] for name in fosssim.scenes() if name.startswith("asset:ImpulsesTests/")]
    (tmp_path / "ImpulsesTests").mkdir()
    for name in names:
        fosssim.simulate(f"asset:{name}").save(tmp_path / f"{name}.bin")
    grade = fosssim.grade(tmp_path)
    table = pd.DataFrame(grade.table)
    assert grade.verdict == "no output" and 0 < grade.points == table["points"].sum() < grade.max_points == 100
    assert set(table[table["verdict"] == "accepted"]["group"]) == {"ImpulsesTests"}
    assert grade.data == json.loads(program("grade", "--traces", str(tmp_path), "--format", "json"))
    (tmp_path / "course.toml").write_text(
        f'schema = 1\nname = "One"\n[[group]]\nname = "A"\nscenes = ["asset:{names[0]}"]\npoints = 4\n'
    )
    assert fosssim.grade(tmp_path, tmp_path / "course.toml").points == 4
    with pytest.raises(fosssim.Error, match="no suite t9.* t1m1"):
        fosssim.grade(tmp_path, "t9")
    (tmp_path / "empty").mkdir()
    with pytest.raises(fosssim.Error, match="contains no trace of a scene of the suite"):
        fosssim.grade(tmp_path / "empty")


def test_a_cut_trace_holds_what_can_be_read():
    scene = fosssim.Scene(SCENE)
    whole = fosssim.simulate(scene)
    cut = fosssim.Trace(scene, whole.data[: len(whole.data) // 2])
    assert 0 < len(cut) < len(whole) and cut.problem
    assert np.array_equal(cut.positions, whole.positions[: len(cut)])
    assert not fosssim.check(scene, cut).accepted


def test_what_is_refused_says_so_in_the_programs_words(tmp_path):
    with pytest.raises(fosssim.Error, match="there is no scene .*; the nearest are asset:ContinuousTimeTests/head-on"):
        fosssim.Scene("asset:ContinuousTimeTests/hed-on")
    with pytest.raises(fosssim.Error, match="has no built-in wrong trace; use asset:.*/flawed"):
        fosssim.Trace(fosssim.scenes()[0] + "/flawed")
    with pytest.raises(fosssim.Error, match="rules must be both, fair or parity, not 'strict'"):
        fosssim.check(FLAWED, rules="strict")
    with pytest.raises(TypeError, match="a pair must be Particles"):
        fosssim.detect((1, 2))
    with pytest.raises(fosssim.Error, match=r"broken:1:\d+: "):
        (tmp_path / "broken").write_text("<scene><particle/></scene>")
        os.chdir(tmp_path)
        fosssim.Scene("broken")
    with pytest.raises(FileNotFoundError):
        fosssim.Scene(tmp_path / "no.xml")
    with pytest.raises(TypeError):
        fosssim.Scene()


def test_pairs_are_those_of_detect():
    edge = fosssim.Edge((3, 1, 4, 1), ((5, 9, 2, 6), (5, 3, 5, 8)), (1, 1))
    pair = fosssim.detect(edge)
    assert pair.collides is False and pair.svg.startswith("<svg")
    printed = program("detect", "pe:3,1+4,1:5,9+2,6:5,3+5,8", "--radii", "1,1", "--format", "json")
    assert pair.data == json.loads(printed)
    assert fosssim.detect(fosssim.Particles((np.zeros(4), (3, 0, -3, 0)), (1, 1))).collides
    with pytest.raises(fosssim.Error, match="normal is zero"):
        fosssim.detect(fosssim.HalfPlane((0, 0, 0, 0), 1, (0, 0), (0, 0)))


def test_the_notebook_runs_anywhere(tmp_path):
    book = json.loads((Path(fosssim.__file__).parent / "examples/trace.ipynb").read_text())
    names: dict = {}
    os.chdir(tmp_path)
    for cell in book["cells"]:
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), names)
    assert names["report"].mistakes

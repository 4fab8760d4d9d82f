"""The module as people use it: the wheel, installed, beside the repository's examples."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import fosssim

ROOT = Path(__file__).resolve().parents[2]
SCENE = "asset:ContinuousTimeTests/spinning-edge-sweeps-balls"
FLAWED = ROOT / "examples/traces/flawed.bin"


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
    report = fosssim.check(scene, FLAWED)
    assert not report.accepted and report.verdict == "wrong answer"
    assert report.steps == 24 and report.wrong_steps[0] == 2 and len(report.wrong_steps) == 23
    assert report.findings[0].count > 0 and "particle 2" in report.findings[0].text
    assert [mistake.key for mistake in fosssim.explain(scene, FLAWED)] == ["pe-square-no-eh"]
    assert report._repr_html_().startswith("<iframe srcdoc=")


def test_reports_and_recordings_are_those_of_the_program(tmp_path):
    written = tmp_path / "reference.bin"
    program("simulate", SCENE, "--output", str(written))
    assert fosssim.simulate(fosssim.Scene(SCENE)).data == written.read_bytes()
    printed = json.loads(program("check", SCENE, "examples/traces/flawed.bin", "--format", "json"))
    trace = fosssim.Trace(fosssim.Scene(SCENE), FLAWED, name="examples/traces/flawed.bin")
    assert fosssim.check(trace.scene, trace).data == printed


def test_a_cut_trace_holds_what_can_be_read():
    scene = fosssim.Scene(SCENE)
    whole = fosssim.simulate(scene)
    cut = fosssim.Trace(scene, whole.data[: len(whole.data) // 2])
    assert 0 < len(cut) < len(whole) and cut.problem
    assert np.array_equal(cut.positions, whole.positions[: len(cut)])
    assert not fosssim.check(scene, cut).accepted


def test_what_is_refused_says_so_in_the_programs_words(tmp_path):
    with pytest.raises(fosssim.FosssimError, match="there is no scene"):
        fosssim.Scene("asset:Nowhere/nothing")
    with pytest.raises(fosssim.FosssimError, match=r"broken:1:\d+: "):
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
    with pytest.raises(fosssim.FosssimError, match="normal is zero"):
        fosssim.detect(fosssim.HalfPlane((0, 0, 0, 0), 1, (0, 0), (0, 0)))


def test_the_notebook_runs():
    book = json.loads((ROOT / "python/examples/trace.ipynb").read_text())
    names: dict = {}
    os.chdir(ROOT / "python/examples")
    for cell in book["cells"]:
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), names)
    assert names["report"].mistakes

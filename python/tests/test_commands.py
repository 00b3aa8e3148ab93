"""Commands as functions, and the command itself."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

import toile
from conftest import PATTERN, PHOTO, QUICK, ROOT

PATTERNS = ROOT / "pipelines/samples/pattern"


def command(*arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    program = [sys.executable, "-m", "toile", *arguments]
    return subprocess.run(program, capture_output=True, text=True, cwd=cwd)


def test_the_command_is_the_same_program() -> None:
    assert command("stage", "Otsu").stdout.startswith("Otsu (binariser, version ")
    told = command("run", "none.ron")
    assert told.returncode == 3 and 'cannot read the pipeline "none.ron"' in told.stderr
    assert command("run").returncode == 2


def test_the_installed_script_is_that_command() -> None:
    script = Path(sys.executable).parent / "toile"
    assert subprocess.run([script, "--version"], capture_output=True, text=True).stdout.startswith("toile ")


def test_stages_of_a_file_of_python_are_known_to_the_command(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(
        "import toile\n"
        "@toile.stage(role='Binariser')\n"
        "def bright(photo, *, level: int = 100):\n"
        "    '''Takes what is bright for garment.'''\n"
        "    return photo.max(axis=2) > level\n"
    )
    card = command("--plugin", str(file), "stage", "Bright").stdout
    assert card.startswith("Bright (binariser, version 1)\n\nTakes what is bright for garment.")
    checked = command("--plugin", str(file), "validate", str(PHOTO), "--set", "stages.Auto=Bright(level: 90)")
    assert checked.returncode == 0, checked.stderr
    assert "valid" in checked.stdout
    gone = command("--plugin", "none.py", "stages")
    assert gone.returncode == 3 and gone.stderr.endswith('none.py"\n')


def test_the_studio_is_in_the_wheel(tmp_path: Path) -> None:
    program = [sys.executable, "-m", "toile", "studio", "--no-open", str(tmp_path)]
    with subprocess.Popen(program, stdout=subprocess.PIPE, text=True) as studio:
        try:
            assert studio.stdout is not None
            found = next(m for line in studio.stdout if (m := re.search(r"(http://127\.0\.0\.1:\d+)/\?token=\w+", line)))
            browser = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
            page = browser.open(found[0]).read().decode()
            script = re.search(r'src="/?([\w./]+\.js)"', page)
            assert script and browser.open(f"{found[1]}/{script[1]}").status == 200
            state = json.load(browser.open(f"{found[1]}/api/state"))
            assert state["project"]["file"] is None
            cards = json.load(browser.open(f"{found[1]}/api/cards"))["stages"]
            assert any(card["name"] == "StaticEquilibrium" for card in cards)
        finally:
            studio.send_signal(signal.SIGINT)
        assert studio.wait(timeout=30) in (0, 5)


def test_a_garment_is_verified(shirt: toile.Run, tmp_path: Path) -> None:
    shirt.save(tmp_path)
    certificate = toile.verify(tmp_path)
    assert certificate["verdict"] == "holds"
    assert (tmp_path / "certificate.json").is_file()
    strict = toile.verify(tmp_path, max_gap="0.000001 mm", max_tight=1, out=tmp_path / "strict.json")
    assert strict["verdict"] == "fails"
    assert any(check["verdict"] == "fails" for check in strict["checks"])
    with pytest.raises(toile.InvalidInputError, match="none.obj"):
        toile.verify(tmp_path / "none.obj")


def test_a_manifest_is_made_of_files() -> None:
    lines = toile.manifest([PATTERNS / "shirt_specification.json", PATTERNS / "trousers_specification.json"], field="pattern.file")
    assert [line["id"] for line in lines] == ["shirt_specification", "trousers_specification"]
    assert Path(lines[0]["set"]["pattern.file"]).name == "shirt_specification.json"
    with pytest.raises(toile.UsageError) as error:
        toile.manifest(PATTERNS / "shirt_specification.json")
    assert error.value.message.startswith("say with --field which value each file is")


def test_a_batch_keeps_garments_and_failures(tmp_path: Path) -> None:
    (tmp_path / "list.jsonl").write_text(
        json.dumps({"id": "good", "set": {"pattern.file": str(PATTERNS / "shirt_specification.json")}})
        + "\n"
        + json.dumps({"id": "bad", "set": {"stages.GridMesher.edge": "400 mm"}})
        + "\n"
    )
    asked = {"pipeline": PATTERN, "out": tmp_path / "out", "until": "GridMesher"}
    first = toile.batch(tmp_path / "list.jsonl", **asked)  # type: ignore[arg-type]
    assert (first.garments, first.good, first.left, first.stopped) == (2, 1, 0, False)
    assert sum(first.faults.values()) == 1
    assert [line["id"] for line in first.results] == ["good", "bad"]
    again = toile.batch(tmp_path / "list.jsonl", **asked)  # type: ignore[arg-type]
    assert again == first


def test_a_manifest_with_faults_is_told_by_line(tmp_path: Path) -> None:
    (tmp_path / "list.jsonl").write_text('{"id": "a"}\n{"id": "a"}\n')
    with pytest.raises(toile.InvalidInputError) as error:
        toile.batch(tmp_path / "list.jsonl", pipeline=PATTERN)
    assert error.value.message == 'the id "a" stands in line 1, too'
    assert error.value.place == "line 2"


@pytest.mark.slow
def test_a_trade_is_measured(tmp_path: Path) -> None:
    record = toile.trade(
        PATTERN, knobs=["mesher.edge=30..40 mm"], out=tmp_path, set=QUICK, budget="2m", starts=0, points=3, repeats=1
    )
    assert record["points"]


def test_what_is_wrong_with_a_trade_is_an_error() -> None:
    with pytest.raises(toile.Error):
        toile.trade(PATTERN, knobs=["no.such=1..2"], budget="1s")

# SPDX-License-Identifier: Apache-2.0
"""The package that pip builds: complete, installable, with one version everywhere."""

import re
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

import tornillo
from tornillo.protocol import FIRMWARE_VERSION

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "host-cli" / "src"


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, built offline with what is installed here."""
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--disable-pip-version-check"]
    command += ["--no-deps", "--no-build-isolation", "-w", str(folder), str(ROOT / "host-cli")]
    subprocess.run(command, check=True)
    (built,) = folder.glob("*.whl")
    return built


def test_the_wheel_is_pure_python_and_has_everything(wheel: Path) -> None:
    assert wheel.name.endswith("-py3-none-any.whl")
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    sources = {
        path.relative_to(SOURCE).as_posix()
        for path in (SOURCE / "tornillo").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert sources <= names
    assert "tornillo/machines/otmt-co.toml" in names
    assert any(name.endswith("licenses/LICENSE") for name in names)


def test_the_wheel_runs_where_it_is_unpacked(wheel: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)
    program = "from tornillo.cli import main; main()"
    example = ROOT / "host-cli" / "examples" / "test-bar.toml"
    done = subprocess.run(
        [sys.executable, "-c", program, "check", str(example)],
        capture_output=True,
        text=True,
        check=False,
        cwd=tmp_path,
        env={"PYTHONPATH": str(tmp_path), "PATH": ""},
    )
    assert done.returncode == 0, done.stderr
    assert "fits otmt-co" in done.stdout


def test_the_version_has_one_source(wheel: Path) -> None:
    source = tomllib.loads((ROOT / "firmware/link/protocol.toml").read_text(encoding="utf-8"))
    version = source["firmware"]["version"]
    assert tornillo.__version__ == FIRMWARE_VERSION == version
    assert wheel.name.startswith(f"tornillo-{version}-")
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    newest = re.search(r"^## (\S+?),? ", changes, re.MULTILINE)
    assert newest is not None
    assert newest[1].rstrip(",") == version


def test_the_licence_of_the_package_is_that_of_the_project() -> None:
    texts = [path.read_bytes() for path in (ROOT / "LICENSE", ROOT / "host-cli" / "LICENSE")]
    assert texts[0] == texts[1]
    assert b"Apache License" in texts[0]
    assert b"CERN-OHL-P-2.0" in (ROOT / "hw" / "LICENSE").read_bytes()


def test_an_unknown_name_of_the_library_is_refused_as_usual() -> None:
    with pytest.raises(AttributeError, match="module 'tornillo' has no attribute 'Lathes'"):
        vars(tornillo)["__getattr__"]("Lathes")
    assert all(getattr(tornillo, name) is not None for name in tornillo.__all__)

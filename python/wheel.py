"""Packs a wheel of a library that cargo has built already (PEP 427), without building it anew.

    python wheel.py LIBRARY FOLDER      prints the wheel's path

`maturin build` makes the same wheel and builds the library for it in a profile of its own; the
tests use what the other tests have compiled.
"""

import base64
import hashlib
import re
import sys
import sysconfig
import zipfile
from pathlib import Path

import tomllib

HERE = Path(__file__).resolve().parent
TAG = f"cp39-abi3-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def metadata(project: dict, version: str) -> str:
    lines = [
        "Metadata-Version: 2.4",
        f"Name: {project['name']}",
        f"Version: {version}",
        f"Summary: {project['description']}",
        f"Requires-Python: {project['requires-python']}",
        f"License-Expression: {project['license']}",
        *(f"License-File: licences/{path.name}" for path in licences()),
        *(f"Requires-Dist: {needed}" for needed in project["dependencies"]),
    ]
    for extra, needs in project["optional-dependencies"].items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f'Requires-Dist: {needed} ; extra == "{extra}"' for needed in needs]
    readme = (HERE / project["readme"]).read_text(encoding="utf-8")
    return "\n".join([*lines, "Description-Content-Type: text/markdown", "", readme])


def licences() -> list:
    return sorted(HERE.glob("licences/*"))


def main(library: Path, folder: Path) -> Path:
    project = tomllib.loads((HERE / "pyproject.toml").read_text())["project"]
    workspace = tomllib.loads((HERE.parent / "Cargo.toml").read_text())["workspace"]
    version = workspace["package"]["version"]
    stem = f"{project['name'].replace('-', '_')}-{version}"
    info = f"{stem}.dist-info"
    files = {f"lacuna/{path.name}": path.read_bytes() for path in sorted((HERE / "lacuna").iterdir()) if path.is_file()}
    files["lacuna/_lacuna.abi3.so"] = library.read_bytes()
    files[f"{info}/METADATA"] = metadata(project, version).encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: wheel.py\nRoot-Is-Purelib: false\nTag: {TAG}\n".encode()
    for path in licences():
        files[f"{info}/licenses/licences/{path.name}"] = path.read_bytes()
    record = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record.append(f"{name},sha256={digest},{len(content)}")
    files[f"{info}/RECORD"] = "\n".join([*record, f"{info}/RECORD,,", ""]).encode()
    folder.mkdir(parents=True, exist_ok=True)
    wheel = folder / f"{stem}-{TAG}.whl"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return wheel


if __name__ == "__main__":
    print(main(Path(sys.argv[1]), Path(sys.argv[2])))

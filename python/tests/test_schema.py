"""The schema of scene files: what it accepts, and what editors make of it.

`taplo` and `tombi` are TOML language servers with a checker, both on PyPI; tests that need one are skipped without.
"""

import json
import queue
import re
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
FOLDERS = ["models/gallery", "models/scenes", "examples/control", "studies/verification", "book/src"]
# one case of the verification has a motion of its own, which nobody else is to use; book.toml is no scene
SCENES = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.toml") if "driven_rod" not in path.name)
WRONG = {
    "an unknown field": ('speed = "1 kn"', 'spede = "1 kn"'),
    "an unknown type": ('type = "straight"', 'type = "straigt"'),
    "a number for a name": ('name = "ship"', "name = 3"),
    "an unknown list": ("[[motions]]", "[[motion]]"),
}
RIGHT = '[run]\nduration = "$time"\n\n[parameters]\ntime = 3\n\n[[motions]]\ntype = "straight"\nname = "ship"\nspeed = "1 kn"\n'
LINE = "#:schema ./scene.schema.json\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("schema")
    subprocess.run([sys.executable, "-m", "ropewalk", "schema", "--out", "scene.schema.json"], cwd=folder, check=True)
    return folder


def tool(name: str) -> str:
    found = shutil.which(name) or shutil.which(name, path=str(Path(sys.executable).parent))
    return found or pytest.skip(f"{name} isn't installed")


def test_all_scenes_fit_and_wrong_ones_do_not(folder):
    jsonschema = pytest.importorskip("jsonschema")
    tomllib = pytest.importorskip("tomllib")
    schema = json.loads((folder / "scene.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    assert len(SCENES) > 80
    for path in SCENES:
        errors = [error.message for error in validator.iter_errors(tomllib.loads(path.read_text(encoding="utf-8")))]
        assert not errors, f"{path}: {errors[0][:400]}"
    assert validator.is_valid(tomllib.loads(RIGHT))
    for what, (old, new) in WRONG.items():
        assert old in RIGHT and not validator.is_valid(tomllib.loads(RIGHT.replace(old, new))), what


@pytest.mark.parametrize("command", [["taplo", "lint"], ["tombi", "lint", "--offline", "--quiet"]], ids=lambda c: c[0])
def test_checkers_of_editors_agree(folder, command):
    program = [tool(command[0]), *command[1:]]
    files = []
    for k, path in enumerate(SCENES):
        file = folder / f"{command[0]}-{k}-{path.name}"
        file.write_text(LINE + path.read_text(encoding="utf-8"), encoding="utf-8")
        files.append(file.name)
    done = subprocess.run([*program, *files], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, (done.stderr + done.stdout)[-3000:]
    for what, (old, new) in WRONG.items():
        (folder / "wrong.toml").write_text(LINE + RIGHT.replace(old, new), encoding="utf-8")
        assert subprocess.run([*program, "wrong.toml"], cwd=folder, capture_output=True).returncode != 0, what


class Server:
    """A language server over its standard input and output."""

    def __init__(self, command: list[str], folder: Path) -> None:
        self.process = subprocess.Popen(command, cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.answers: queue.Queue[dict[str, Any]] = queue.Queue()
        self.count = 0
        threading.Thread(target=self._read, daemon=True).start()
        root = folder.as_uri()
        capabilities = {"textDocument": {"hover": {"contentFormat": ["markdown"]}, "completion": {}}}
        asked = {"processId": None, "rootUri": root, "capabilities": capabilities, "workspaceFolders": [{"uri": root, "name": "scenes"}]}
        self.ask("initialize", asked)
        self._send({"method": "initialized", "params": {}})

    def _read(self) -> None:
        out = self.process.stdout
        assert out is not None
        while line := out.readline():
            if length := re.match(rb"Content-Length: (\d+)", line, re.IGNORECASE):
                while out.readline().strip():
                    pass
                self.answers.put(json.loads(out.read(int(length[1]))))

    def _send(self, message: dict[str, Any]) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        assert self.process.stdin is not None
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        self.process.stdin.flush()

    def ask(self, method: str, params: dict[str, Any], seconds: float = 60) -> Any:
        self.count += 1
        self._send({"id": self.count, "method": method, "params": params})
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            answer = self.answers.get(timeout=seconds)
            if "method" in answer:
                if "id" in answer:
                    self._send({"id": answer["id"], "result": None})
            elif answer.get("id") == self.count:
                return answer.get("result")
        raise TimeoutError(method)

    def open(self, path: Path) -> None:
        document = {"uri": path.as_uri(), "languageId": "toml", "version": 1, "text": path.read_text(encoding="utf-8")}
        self._send({"method": "textDocument/didOpen", "params": {"textDocument": document}})


def test_hovering_and_completion(folder):
    text = LINE + RIGHT + '\n[[forces]]\ntype = ""\n\n[[elements]]\ntype = "cable"\nname = "rope"\ntransverse = ""\nsection = { mass = 1, ea = 1e5 }\n'
    path = folder / "typed.toml"
    path.write_text(text, encoding="utf-8")
    server = Server([tool("tombi"), "lsp", "--offline"], folder)
    try:
        server.open(path)

        def at(method: str, mark: str, offset: int) -> Any:
            before = text[: text.index(mark) + offset]
            place = {"line": before.count("\n"), "character": len(before.rsplit("\n", 1)[-1])}
            asked = {"textDocument": {"uri": path.as_uri()}, "position": place}
            # the schema is read after the scene, and the server has no answer until then
            until = time.monotonic() + 60
            while not (answer := server.ask(f"textDocument/{method}", asked)) and time.monotonic() < until:
                time.sleep(0.2)
            return answer

        assert "Speed after the ramp [m/s]" in at("hover", 'speed = "1 kn"', 1)["contents"]["value"]
        assert "Duration of the run [s]" in at("hover", "duration =", 1)["contents"]["value"]
        assert "Axial stiffness EA [N]" in at("hover", "ea = ", 1)["contents"]["value"]

        def offered(mark: str) -> dict[str, str]:
            answer = at("completion", mark, len(mark) - 1)
            items = answer["items"] if isinstance(answer, dict) else answer
            return {item["label"].strip('"'): json.dumps(item.get("documentation", "")) for item in items}

        forces = offered('type = ""')
        assert {"gravity", "drag", "buoyancy", "spring"} <= set(forces) and "Weight" in forces["gravity"]
        assert {"T1", "T2", "T3"} <= set(offered('transverse = ""'))
    finally:
        server.process.kill()
        server.process.wait()

"""The project's own files, for the rules beside this file."""

import pathlib
import subprocess

FOLDERS = ["core", "shaders", "gl", "scene", "frame_link", "billboard_lod", "client_renderer", "warp_server", "apps",
           "tests", "bench", "examples"]


def cpp_files(root: pathlib.Path):
    """Headers and sources, sorted; those not tracked yet too."""
    return sorted(path for folder in FOLDERS for path in (root / folder).rglob("*") if path.suffix in (".cpp", ".h"))


def project_files(root: pathlib.Path):
    """What git tracks, or everything outside of build folders where the project is no git checkout."""
    listed = subprocess.run(["git", "-C", root, "ls-files", "-z"], capture_output=True, text=True)
    if listed.returncode == 0 and listed.stdout:
        paths = [root / name for name in listed.stdout.split("\0") if name]
    else:
        paths = [path for path in root.rglob("*") if "build" not in path.relative_to(root).parts]
    return sorted(path for path in paths if path.is_file())


def finish(rule: str, problems: list[str]):
    """Prints each problem and ends the process with the outcome."""
    for problem in problems:
        print(problem)
    print(f"{rule}: {len(problems)} problems" if problems else f"{rule}: in order")
    raise SystemExit(1 if problems else 0)

"""Times from a .csg to a picture of 1024 x 768 pixels, beside OpenSCAD's.

    cargo build --release && python3 models/times.py

prints a table of this folder's models: seconds of the processor that solidray takes and that
`openscad --render` takes (with xvfb-run, as its 2021 version needs a display), the best of three runs
of each, or of one where OpenSCAD takes longer than 10 s. It is given up after 300 s.
"""

import pathlib
import resource
import subprocess
import tempfile

HERE = pathlib.Path(__file__).parent
SOLIDRAY = HERE.parent / "target" / "release" / "solidray"
MODELS = ["ball", "classic", "bolt", "flange", "bracket", "die", "pencils", "dovetail",
          "enclosure", "pawn", "gear", "plate"]
LIMIT = 300


def seconds(command):
    """Seconds of the processor that a command and its children take."""
    def spent():
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    before = spent()
    try:
        done = subprocess.run(command, timeout=LIMIT, capture_output=True)
    except subprocess.TimeoutExpired:
        return None
    if done.returncode != 0:
        raise SystemExit(f"{command}: {done.stderr.decode()}")
    return spent() - before


def best(command):
    """The best of three runs, or of one long one."""
    first = seconds(command)
    if first is None or first > 10:
        return first
    return min([first] + [seconds(command) for _ in range(2)])


def main():
    print("| model | solidray, s | `openscad --render`, s | |")
    print("|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name in MODELS:
            model = str(HERE / f"{name}.csg")
            picture = str(pathlib.Path(folder) / "picture.png")
            ours = best([SOLIDRAY, "render", model, "-o", picture, "--imgsize", "1024,768"])
            theirs = best(["xvfb-run", "-a", "openscad", "--render", "--imgsize=1024,768",
                           "-o", picture, model])
            shown = f"over {LIMIT}" if theirs is None else f"{theirs:.2f}"
            ratio = "" if theirs is None else f"{theirs / ours:.{int(theirs < 3 * ours)}f}×"
            print(f"| {name} | {ours:.3f} | {shown} | {ratio} |", flush=True)


if __name__ == "__main__":
    main()

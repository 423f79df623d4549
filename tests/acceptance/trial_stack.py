"""The parts that kill_trial and interruption_trial share: a stack of a second, and the files that must be the same."""

SMALL = ["assets/stacks/demo.toml", "--set", "detector.pixels=24", "--set", "detector.size_mm=0.48", "--rays", "4e5",
         "--set", "output.checkpoint_s=0.05", "--set", "diffraction.model=none"]


def files(folder):
    return {path.relative_to(folder): path.read_bytes() for path in sorted(folder.rglob("*"))
            if path.is_file() and not path.name.startswith(("timings.", "checksums"))}

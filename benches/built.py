"""Where cargo left a bench's program."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def newest(bench: str) -> Path:
    """What `cargo build --release --bench NAME` made last."""
    made = (ROOT / "target/release/deps").glob(f"{bench}-*")
    made = [path for path in made if path.suffix != ".d"]
    if not made:
        raise FileNotFoundError(f"build it first: cargo build --release --bench {bench}")
    return max(made, key=lambda path: path.stat().st_mtime)

"""The wheel from which this package was installed, and the programs in it."""

import json
from importlib.metadata import Distribution, distributions
from pathlib import Path


def program(name: str) -> Path | None:
    """A program that was installed together with this package."""
    found = _distribution()
    if found is None:
        return None
    places = [_place(found, file) for file in found.files or () if file.name == name]
    # `pip install --target` moves programs after it has written where they are.
    places.append(_place(found, Path("bin", name)))
    return next((place for place in places if place.is_file()), None)


def wheel() -> str | None:
    """The URL of the wheel that this package comes from."""
    found = _distribution()
    origin = json.loads(found and found.read_text("direct_url.json") or "{}")
    return origin.get("url") if "archive_info" in origin else None


def _distribution() -> Distribution | None:
    """The installed distribution that holds this very file, not one of another folder."""
    here = Path(__file__).resolve()
    for found in distributions(name="impinge"):
        if _place(found, Path("impinge", here.name)) == here:
            return found
    return None


def _place(found: Distribution, file: Path) -> Path:
    return Path(str(found.locate_file(file))).resolve()

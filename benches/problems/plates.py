"""Scenes of one solid with loads and probes."""

from problems.materials import ALUMINA, thermoelastic

START = 293.15  # K


def scene(body: dict, stop: float, step: float, name: str = "Plate", **tables) -> dict:
    """A plate alone, of alumina unless its table says otherwise, with loads, probes and more."""
    material = thermoelastic(ALUMINA)
    whole = {"kind": "solid", "material": material, "initial_temperature": START} | body
    return {"name": name, "stop_time": stop, "step": step, "body": {"plate": whole}} | tables


def probe(name: str, at: list[float], *gives: str, body: str = "plate", **more) -> dict:
    return {"name": name, "in": body, "at": at, "gives": list(gives)} | more


CENTRE = probe("centre", [0.0, 0.0, 0.0], "temperature")


def load(footprint: dict, carries: str, value: float, name: str = "spot", **more) -> dict:
    """A load on the top."""
    start = {carries: value} | more.pop("start", {})
    own = {"name": name, "on": "plate.top", "footprint": footprint, "carries": [carries]}
    return own | {"start": start} | more


def disc(radius: float) -> dict:
    return {"disc": {"radius": radius}}

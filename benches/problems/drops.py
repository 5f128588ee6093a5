"""Scenes of a drop that hits a wall or a plate."""


def droplet(diameter: float, speed: float, temperature: float, fluid: dict, **more) -> dict:
    drop = {
        "kind": "droplet",
        "diameter": diameter,
        "impact_velocity": speed,
        "initial_temperature": temperature,
        "fluid": fluid,
    }
    return drop | more


def wall(count: int, radius: float, temperature: float, **more) -> dict:
    """Rings under the drop, held at a temperature."""
    footprint = {"rings": {"count": count, "radius": radius}}
    own = {"name": "wall", "under": "drop", "footprint": footprint}
    return own | {"start": {"temperature": temperature}} | more


def on_plate(radius: float, **more) -> dict:
    """The coupling of a drop to a plate, whose mesh is fine within the radius."""
    return {"from": "drop", "to": "plate.top", "radius": radius, "traction": False} | more

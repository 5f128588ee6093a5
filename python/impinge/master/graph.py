"""In which order units advance: components that depend on each other in a ring, and cuts through
these."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping, Sequence
from itertools import permutations
from typing import TypeVar

from impinge.master.any_unit import AnyUnit
from impinge.master.connection import Link
from impinge.unit.variable import stem_of

Node = TypeVar("Node", bound=Hashable)
_FEW = 7  # units in a ring up to which all orders are tried


def components(nodes: Sequence[Node], after: Mapping[Node, Iterable[Node]]) -> list[list[Node]]:
    """Strongly connected components, each before those that follow from it.

    `after` names what follows from a node. R. Tarjan (1972), doi 10.1137/0201010; without
    recursion.
    """
    index: dict[Node, int] = {}
    low: dict[Node, int] = {}
    stack: list[Node] = []
    on_stack: set[Node] = set()
    found: list[list[Node]] = []
    for root in nodes:
        if root in index:
            continue
        work = [(root, iter(list(after.get(root, ()))))]
        index[root] = low[root] = len(index)
        stack.append(root)
        on_stack.add(root)
        while work:
            node, rest = work[-1]
            advanced = False
            for following in rest:
                if following not in index:
                    index[following] = low[following] = len(index)
                    stack.append(following)
                    on_stack.add(following)
                    work.append((following, iter(list(after.get(following, ())))))
                    advanced = True
                    break
                if following in on_stack:
                    low[node] = min(low[node], index[following])
            if advanced:
                continue
            work.pop()
            if work:
                low[work[-1][0]] = min(low[work[-1][0]], low[node])
            if low[node] == index[node]:
                component = []
                while True:
                    member = stack.pop()
                    on_stack.remove(member)
                    component.append(member)
                    if member == node:
                        break
                found.append(sorted(component, key=list(nodes).index))
    return found[::-1]


def unit_components(units: Mapping[str, AnyUnit], links: Sequence[Link]) -> list[list[str]]:
    """Groups of units that depend on each other, in the order in which they can advance."""
    after: dict[str, set[str]] = {name: set() for name in units}
    for link in links:
        after[link.source_unit].add(link.target_unit)
    return components(list(units), after)


def follows_at_once(units: Mapping[str, AnyUnit], first: Link, second: Link) -> bool:
    """Returns true if the source of the second link follows the target of the first at once."""
    if first.target_unit != second.source_unit:
        return False
    return follows(units[first.target_unit], first.target, second.source)


def follows(unit: AnyUnit, target: str, source: str) -> bool:
    """Returns true if a unit declares that a source follows one of its inputs at once."""
    if unit.variable(source).causality != "output":
        return True  # of locals nothing is declared
    return stem_of_family(unit, target) in unit.depends_on(source)


def stem_of_family(unit: AnyUnit, name: str) -> str:
    return name if name in unit.variables else stem_of(name)


def best_order(
    units: Mapping[str, AnyUnit], members: Sequence[str], links: Sequence[Link]
) -> list[str]:
    """The order of a ring's units that makes the least of what has to be guessed.

    First, means over a step are never guessed; then, inputs that outputs follow at once come from
    units that have advanced already; then, as few numbers as can be are guessed.
    """
    inner = [k for k in links if k.source_unit in members and k.target_unit in members]
    direct = {
        id(link): any(follows_at_once(units, link, other) for other in inner) for link in inner
    }

    def cost(order: Sequence[str]) -> tuple[int, int, int]:
        place = {name: i for i, name in enumerate(order)}
        back = [k for k in inner if place[k.source_unit] >= place[k.target_unit]]
        return (
            sum(k.size for k in back if k.is_mean),
            sum(k.size for k in back if direct[id(k)]),
            sum(k.size for k in back),
        )

    if len(members) <= _FEW:
        return list(min(permutations(members), key=cost))
    order = list(members)  # pairs are exchanged as long as that helps
    improved = True
    while improved:
        improved = False
        for i in range(len(order) - 1):
            other = [*order[:i], order[i + 1], order[i], *order[i + 2 :]]
            if cost(other) < cost(order):
                order, improved = other, True
    return order

"""What linear units make of their inputs, as matrices: for controllers and optimisers."""

from impinge.linear.identify import linear_map
from impinge.linear.map import LinearMap
from impinge.linear.planning import Plan, plan
from impinge.linear.realisation import NotRealised, StateSpace
from impinge.linear.rollout import NotLinear
from impinge.linear.sensitivity import Sensitivity, step_sensitivity

__all__ = [
    "LinearMap",
    "NotLinear",
    "NotRealised",
    "Plan",
    "Sensitivity",
    "StateSpace",
    "linear_map",
    "plan",
    "step_sensitivity",
]

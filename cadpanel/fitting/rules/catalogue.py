"""The rules that a file may have, in the order in which they set radii. A new one is a file of its own and a line."""

from __future__ import annotations

from cadpanel.fitting.rules.equal import EqualRule
from cadpanel.fitting.rules.feature import FeatureRule
from cadpanel.fitting.rules.kinds import KindsRule
from cadpanel.fitting.rules.level import LevelRule
from cadpanel.fitting.rules.lock import LockRule
from cadpanel.fitting.rules.mirror import MirrorRule
from cadpanel.fitting.rules.rule import Rule
from cadpanel.fitting.rules.seam import SeamRule
from cadpanel.fitting.rules.shop import ShopRule

RULES: tuple[type[Rule], ...] = (FeatureRule, SeamRule, LevelRule, LockRule, MirrorRule, EqualRule, KindsRule, ShopRule)

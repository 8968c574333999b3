"""The charts of the report, in the order in which the report shows them."""

from game.report.charts import (
    broadphases,
    chaos,
    contacts,
    continuous,
    effects,
    far,
    integration,
    joints,
    latency,
    papers,
    peers,
    scenes,
    solvers,
    tiers,
)

CHARTS = (
    tiers.CHART,
    contacts.CHART,
    tiers.FIT_CHART,
    solvers.CHART,
    integration.CHART,
    continuous.CHART,
    continuous.TIME_CHART,
    broadphases.CHART,
    far.CHART,
    effects.CHART,
    chaos.CHART,
    latency.CHART,
    scenes.CHART,
    peers.CHART,
    papers.CHART,
    joints.CHART,
)

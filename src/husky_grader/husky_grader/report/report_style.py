# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The look of a report, on a desk, on a phone and in the dark."""

STYLE = """
:root { color-scheme: light dark; --ink: #1c2430; --soft: #667; --page: #fff; --line: #d5dae1;
  --given: #1f5fa8; --true: #22824a; --believed: #b87a00; --bad: #c62828; --solid: #9aa1ab;
  --band: #1f5fa833; --band-good: #22824a26; --error: #c6282859; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e9ee; --soft: #9aa3b2; --page: #14181f;
  --line: #333b47; --given: #74aaf0; --true: #5fcf8f; --believed: #e8b04a; --bad: #ff7b72;
  --solid: #5b6472; --band: #74aaf033; --band-good: #5fcf8f26; --error: #ff7b7259; } }
body { margin: 0 auto; padding: 1rem; max-width: 60rem; background: var(--page);
  color: var(--ink); font: 16px/1.45 system-ui, sans-serif; }
h1 { font-size: 1.4rem; margin: 0 0 .3rem; } h2 { font-size: 1.1rem; margin: 1.4rem 0 .4rem; }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; padding: .25rem .6rem .25rem 0; border-bottom: 1px solid var(--line);
  vertical-align: top; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.score { font-size: 2.4rem; font-weight: 700; } .bad { color: var(--bad); }
.good { color: var(--true); } .soft, figcaption { color: var(--soft); font-size: .9rem; }
figure { margin: .5rem 0; } section p { margin: 0; }
svg { width: 100%; height: auto; display: block; }
svg.map { max-width: 42rem; border: 1px solid var(--line); border-radius: .4rem; }
svg text { font: 13px system-ui, sans-serif; fill: var(--soft); }
svg polyline { fill: none; stroke-width: 2; stroke-linejoin: round; }
svg.map polyline:not(.band) { vector-effect: non-scaling-stroke; }
svg.map text { font-size: 26px; paint-order: stroke; stroke: var(--page); stroke-width: 7px; }
svg .grid { stroke: var(--line); } svg .obstacle { fill: var(--solid); }
svg circle.waypoint { fill: var(--given); } svg.map text.waypoint { fill: var(--given); }
svg circle.missed { fill: var(--page); stroke: var(--bad); stroke-width: 5; }
svg.map text.missed { fill: var(--bad); font-weight: 700; font-size: 32px; }
svg .start { fill: var(--ink); } svg .mark { fill: var(--bad); }
svg.map text.hit { fill: #fff; stroke: none; font-size: 24px; text-anchor: middle;
  dominant-baseline: central; }
svg polyline.band { stroke: var(--given); opacity: .2; stroke-linecap: round; }
svg polyline.given { stroke: var(--given); stroke-width: 3; }
svg polyline.true { stroke: var(--true); } svg .error { fill: var(--bad); opacity: .35; }
svg .believed { stroke: var(--believed); stroke-dasharray: 6 4; }
svg .asked { stroke: var(--given); stroke-dasharray: 4 4; }
svg .commanded { stroke: var(--believed); } svg .good { fill: var(--true); opacity: .15; }
svg .moment { stroke: var(--bad); stroke-width: 2; }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(19rem, 1fr)); gap: 0 2rem; }
dl { font-size: .9rem; color: var(--soft); }
dt { color: var(--ink); } dd { margin: 0 0 .4rem 1rem; }
.key span { margin-right: 1rem; display: inline-block; } .key i { display: inline-block;
  width: 1.4rem; height: .4rem; margin-right: .35rem; vertical-align: middle; }
.hash { overflow-wrap: anywhere; } table.figures { max-width: 28rem; }
@media (max-width: 32rem) {
  svg.map text { font-size: 40px; } svg.map text.missed, svg.map text.hit { font-size: 44px; }
  svg.map .mark { r: 26px; } svg.plot text { font-size: 16px; }
  .parts tr { display: grid; grid-template-columns: 1fr 5rem 5rem; padding: .25rem 0;
    border-bottom: 1px solid var(--line); }
  .parts td, .parts th { border: 0; text-align: right; padding: 0; }
  .parts td:first-child, .parts th:first-child { text-align: left; }
  .parts td:last-child { grid-column: 1 / -1; text-align: left; color: var(--soft);
    font-size: .9rem; }
  .parts th:last-child { display: none; }
}
"""

# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Where the pointer is: its x and y on the ground, and the name of the obstacle there.

The page finds it by itself from its camera, which viser has as `window.__viserMutable`; nothing is
sent for it.
"""

POINTER_SCRIPT = """
if (window.huskyPointer) return;
const words = window.huskyPointer = document.createElement('div');
words.id = 'husky-pointer';
words.hidden = true;
words.style.cssText = 'position:fixed;left:.8em;bottom:.8em;z-index:5;pointer-events:none;' +
  'padding:.25em .6em;border-radius:.3em;background:#fffd;color:#111;font:14px system-ui,' +
  'sans-serif;font-variant-numeric:tabular-nums';
document.body.append(words);
const TALLEST = 1.15;
// A matrix of three.js (by columns) times a point.
const times = (m, [x, y, z]) => {
  const [a, b, c, w] = [0, 1, 2, 3].map((i) => m[i] * x + m[4 + i] * y + m[8 + i] * z + m[12 + i]);
  return [a / w, b / w, c / w];
};
// What a rigid motion has taken from there to here, back.
const back = (m, p) => {
  const q = p.map((value, i) => value - m[12 + i]);
  return [0, 1, 2].map((i) => m[4 * i] * q[0] + m[4 * i + 1] * q[1] + m[4 * i + 2] * q[2]);
};
const ray = (viewer, e) => {
  const box = viewer.canvas.getBoundingClientRect();
  const x = 2 * (e.clientX - box.left) / box.width - 1;
  const y = 1 - 2 * (e.clientY - box.top) / box.height;
  const { projectionMatrixInverse, matrixWorld } = viewer.camera;
  const root = viewer.nodeRefFromName[''].matrixWorld.elements;
  const ahead = times(projectionMatrixInverse.elements, [x, y, 0.5]);
  return [[0, 0, 0], ahead].map((p) => back(root, times(matrixWorld.elements, p)));
};
const at = ([from, to], height) => {
  const part = (height - from[2]) / (to[2] - from[2]);
  return part > 0 ? [0, 1].map((i) => from[i] + part * (to[i] - from[i])) : null;
};
const within = ([, x, y, yaw, ...size], [px, py]) => {
  const [dx, dy] = [px - x, py - y];
  if (size.length === 1) return Math.hypot(dx, dy) < size[0];
  const along = dx * Math.cos(yaw) + dy * Math.sin(yaw);
  const across = dy * Math.cos(yaw) - dx * Math.sin(yaw);
  return Math.abs(along) < size[0] / 2 && Math.abs(across) < size[1] / 2;
};
const first = (line, { height, obstacles }) => {
  for (let above = TALLEST; above >= 0; above -= 0.05) {
    const place = at(line, height + above);
    const hit = place && obstacles.find((each) => within(each, place));
    if (hit) return hit[0];
  }
  return '';
};
const decimals = (value) => (Math.round(value * 100) / 100 + 0).toFixed(2).replace('-', '\\u2212');
window.addEventListener('pointermove', (e) => {
  const viewer = window.__viserMutable, given = document.querySelector('[data-ground]');
  words.hidden = true;
  if (e.target.tagName !== 'CANVAS' || !given || !viewer?.camera) return;
  const ground = JSON.parse(given.dataset.ground), line = ray(viewer, e);
  const place = at(line, ground.height);
  if (!place) return;
  const [x, y, yaw] = ground.frame, [dx, dy] = [place[0] - x, place[1] - y];
  const along = dx * Math.cos(yaw) + dy * Math.sin(yaw);
  const left = dy * Math.cos(yaw) - dx * Math.sin(yaw);
  const parts = [ground.name, `x ${decimals(along)}`, `y ${decimals(left)}`, first(line, ground)];
  words.textContent = parts.filter(Boolean).join('   ');
  words.style.whiteSpace = 'pre';
  words.hidden = false;
}, true);
"""

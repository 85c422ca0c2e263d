'use strict';
(() => {
const data = JSON.parse(document.getElementById('data').textContent);
const find = (id) => document.getElementById(id);
const make = (tag, properties = {}, ...children) => {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
};
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const kColors = ['#1f77b4', '#d95f02', '#2ca02c', '#d62728', '#9467bd', '#8c564b', '#e377c2', '#7f7f7f', '#a0a000', '#17becf',
                 '#5254a3', '#e6ab02', '#1b9e77', '#a6761d', '#e7298a', '#66a61e', '#6b6ecf'];
const colorOf = (i) => kColors[i % kColors.length];
// Columns travel as base64 of little-endian 32-bit numbers.
const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
const floats = (text) => new Float32Array(bytes(text).buffer);
const runs = data.runs;
for (const run of runs) run.times = run.times ? floats(run.times) : null;

find('intro').textContent = data.intro;
for (const [name, value] of data.manifest) find('manifest').append(make('dt', {textContent: name}), make('dd', {textContent: value}));

// --- the table
const table = {column: -1, down: false, order: runs.map((_, i) => i)};
let chosen = 0;

function sortTable(column) {
  table.down = table.column === column ? !table.down : false;
  table.column = column;
  const key = (i) => runs[i].cells[column].key;
  const isNone = (k) => k === null;
  table.order.sort((a, b) => {
    const [x, y] = [key(a), key(b)];
    if (isNone(x) || isNone(y)) return isNone(x) - isNone(y) || a - b;  // what has no value stays at the end
    const order = x < y ? -1 : x > y ? 1 : 0;
    return (table.down ? -order : order) || a - b;
  });
  drawRows();
}

function drawRows() {
  const body = make('tbody');
  for (const i of table.order) {
    const row = make('tr', {tabIndex: 0, onclick: () => choose(i)});
    row.onkeydown = (e) => { if (e.key === 'Enter' || e.key === ' ') { e.preventDefault(); choose(i); } };
    row.setAttribute('aria-selected', i === chosen);
    row.append(...runs[i].cells.map((cell) => make('td', {textContent: cell.text})));
    body.append(row);
  }
  const old = find('errors').tBodies[0];
  old ? old.replaceWith(body) : find('errors').append(body);
  [...find('errors').tHead.rows[0].cells].forEach((cell, i) => {
    cell.setAttribute('aria-sort', i !== table.column ? 'none' : table.down ? 'descending' : 'ascending');
  });
}

function makeTable() {
  const head = make('tr');
  data.columns.forEach((column, i) => {
    const button = make('button', {type: 'button', textContent: column.heading, onclick: () => sortTable(i)});
    head.append(make('th', {scope: 'col', title: column.meaning}, button));
  });
  find('errors').append(make('thead', {}, head));
  drawRows();
}

// --- curves over frames. Of long runs the least and the greatest of each group of frames in view are drawn; zooming in takes
// smaller groups from the whole column, down to single frames.
const kMost = 3000;
const options = () => ({
  legend: 'follow', labelsSeparateLines: true, gridLineColor: css('--line'), axisLineColor: css('--line'),
  animatedZooms: false, xRangePad: 4, yLabelWidth: 16, axes: {y: {axisLabelWidth: 46}},
});
let timesChart = null, spreadChart = null, mixChart = null, inBlock = [], shown = new Set(), range = [0, 1], longest = 1;

function thinned(list, from, to) {
  const step = Math.max(1, Math.ceil((to - from) / (kMost / 2)));
  const rows = [];
  for (let at = from; at < to; at += step) {
    const end = Math.min(to, at + step);
    const low = [at], high = [(at + end - 1) / 2 + 0.25];
    for (const run of list) {
      let least = Infinity, most = -Infinity;
      for (let k = at; k < end && k < run.times.length; ++k) {
        const v = run.times[k];
        if (v < least) least = v;
        if (v > most) most = v;
      }
      low.push(least === Infinity ? null : least);
      high.push(most === -Infinity ? null : most);
    }
    rows.push(low);
    if (step > 1) rows.push(high);
  }
  return {rows, step};
}

function drawTimes() {
  const list = inBlock.filter((i) => shown.has(i)).map((i) => runs[i]);
  const [from, to] = [Math.max(0, Math.floor(range[0])), Math.min(longest, Math.ceil(range[1]))];
  const target = runs[inBlock[0]].target_ms;
  const {rows, step} = thinned(list, from, Math.max(to, from + 1));
  for (const row of rows) row.push(target);
  const labels = ['frame', ...list.map((r) => r.label), 'target'];
  const colors = [...inBlock.flatMap((i, k) => shown.has(i) ? [colorOf(k)] : []), css('--text')];
  if (timesChart) timesChart.destroy();
  timesChart = new Dygraph(find('times'), rows, {...options(), labels, colors, xlabel: 'frame', ylabel: 'frame time, ms',
    includeZero: true, series: {target: {strokePattern: [6, 4]}}, dateWindow: [from, Math.max(to - 1, from + 1)],
    zoomCallback: (low, high) => { const all = high - low >= to - from - 1.5 && step === 1; if (!all) zoomTo(low, high + 1); }});
  timesChart.canvas_.parentNode.ondblclick = () => zoomTo(0, longest);
  find('times-note').textContent = step > 1
      ? `Frames ${from} to ${to - 1} of ${longest}; the least and the greatest of every ${step} frames are drawn. Drag across to zoom in.`
      : `Frames ${from} to ${to - 1} of ${longest}, each of them. Drag across to zoom in, double click for all.`;
}

function zoomTo(from, to) {
  const width = Math.min(longest, Math.max(2, to - from));
  const low = Math.min(Math.max(0, from), longest - width);
  range = [low, low + width];
  drawTimes();
}

const kZooms = {
  in: ([a, b]) => [a + (b - a) / 4, b - (b - a) / 4], out: ([a, b]) => [a - (b - a) / 2, b + (b - a) / 2],
  left: ([a, b]) => [a - (b - a) / 3, b - (b - a) / 3], right: ([a, b]) => [a + (b - a) / 3, b + (b - a) / 3],
  all: () => [0, longest],
};

function drawSpread() {
  const list = inBlock.filter((i) => shown.has(i));
  const steps = 200, target = runs[inBlock[0]].target_ms;
  const sorted = list.map((i) => runs[i].sorted ??= Float32Array.from(runs[i].times).sort());
  const most = Math.max(target * 1.5, ...sorted.map((s) => Math.min(s[Math.floor(0.99 * (s.length - 1))], target * 4)));
  const below = (s, limit) => {
    let low = 0, high = s.length;
    while (low < high) { const mid = (low + high) >> 1; s[mid] <= limit ? low = mid + 1 : high = mid; }
    return low / s.length;
  };
  const rows = [];
  for (let k = 0; k <= steps; ++k) { const t = most * k / steps; rows.push([t, ...sorted.map((s) => below(s, t))]); }
  if (spreadChart) spreadChart.destroy();
  spreadChart = new Dygraph(find('spread'), rows, {...options(), labels: ['ms', ...list.map((i) => runs[i].label)],
    colors: inBlock.flatMap((i, k) => shown.has(i) ? [colorOf(k)] : []), valueRange: [0, 1.02], xlabel: 'frame time, ms',
    ylabel: 'share of frames',
    underlayCallback: (context, area, chart) => {
      const x = chart.toDomXCoord(target);
      context.strokeStyle = css('--text'); context.setLineDash([6, 4]);
      context.beginPath(); context.moveTo(x, area.y); context.lineTo(x, area.y + area.h); context.stroke();
      context.setLineDash([]);
    }});
}

function drawMix() {
  const mix = runs[Number(find('run').value)].mix;
  if (mixChart) mixChart.destroy();
  mixChart = new Dygraph(find('mix'), mix.rows, {...options(), stackedGraph: true, fillAlpha: 0.6, xlabel: 'frame', ylabel: 'share of items',
    labels: ['frame', 'finest', 'fine', 'middle', 'coarse', 'not drawn'], colors: ['#1a9850', '#91cf60', '#d9a400', '#fc8d59', '#888888'],
    valueRange: [0, 1.001], stackedGraphNaNFill: 'none'});
}

function drawCurves() {
  const box = find('curves');
  box.querySelectorAll('label').forEach((label) => label.remove());
  inBlock.forEach((i, k) => {
    const tick = make('input', {type: 'checkbox', checked: shown.has(i)});
    tick.onchange = () => {
      tick.checked ? shown.add(i) : shown.delete(i);
      drawTimes(); drawSpread();
    };
    const swatch = make('span', {className: 'swatch'});
    swatch.style.background = colorOf(k);
    box.append(make('label', {}, tick, swatch, runs[i].label));
  });
}

function chooseBlock(index) {
  const block = data.blocks[index];
  inBlock = block.runs.filter((i) => runs[i].times);
  find('block').value = index;
  find('run').replaceChildren(...inBlock.map((i) => make('option', {value: i, textContent: runs[i].label})));
  longest = Math.max(1, ...inBlock.map((i) => runs[i].times.length));
  // The closest few first: all at once would hide each other.
  shown = new Set([...inBlock].sort((a, b) => runs[a].avg_err - runs[b].avg_err || a - b).slice(0, 5));
  if (inBlock.length) find('run').value = [...shown][0];  // the closest to the target
  range = [0, longest];
  drawBlock(block);
}

function drawBlock(block) {
  const some = inBlock.length > 0;
  for (const id of ['times', 'spread', 'mix']) find(id).hidden = !some;
  if (some) { drawCurves(); drawTimes(); drawSpread(); drawMix(); }
  else find('times-note').textContent = 'No rows of frames are stored for this scene and target: sweep with frames = true keeps them.';
  drawWork(block);
}

function choose(i) {
  chosen = i;
  for (const row of find('errors').tBodies[0].rows) row.setAttribute('aria-selected', false);
  find('errors').tBodies[0].rows[table.order.indexOf(i)].setAttribute('aria-selected', true);
  if (!data.blocks[find('block').value].runs.includes(i)) chooseBlock(data.blocks.findIndex((b) => b.runs.includes(i)));
  if (!runs[i].times) return;
  shown.add(i);
  find('run').value = i;
  drawCurves(); drawTimes(); drawSpread(); drawMix();
}

// --- work and precision
function drawWork(block) {
  const error = find('work-error').value;
  const points = [], left = [];
  for (const i of block.runs) {
    const run = runs[i], x = run[error], y = run.operations;
    x === null || !(x >= 0) ? left.push(run.label) : points.push({x, y, run, color: colorOf(block.runs.indexOf(i))});
  }
  const [w, h, pad] = [900, 420, 60];
  // Logarithmic, with a margin of a tenth; marks at 1, 2 and 5 times the powers of ten where there are few of these.
  const scale = (values, low, high) => {
    const above = values.filter((v) => v > 0);
    const [least, most] = above.length ? [Math.min(...above), Math.max(...above)].map(Math.log10) : [0, 1];
    const from = least - 0.1 * (most - least + 0.5), to = most + 0.1 * (most - least + 0.5);
    const at = (v) => v > 0 ? low + (high - low) * (0.06 + 0.94 * (Math.log10(v) - from) / (to - from)) : low;
    const marks = (steps) => {
      const list = [];
      for (let e = Math.floor(from); e <= to; ++e) list.push(...steps.map((s) => s * 10 ** e));
      return list.filter((v) => Math.log10(v) >= from && Math.log10(v) <= to);
    };
    return {at, marks: marks([1]).length > 2 ? marks([1]) : marks([1, 2, 5])};
  };
  const x = scale(points.map((p) => p.x), pad, w - 130), y = scale(points.map((p) => p.y), h - pad, 16);
  const kSvg = 'http://www.w3.org/2000/svg';
  const draw = (tag, attributes, text) => {
    const element = document.createElementNS(kSvg, tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    if (text !== undefined) element.textContent = text;
    return element;
  };
  const svg = draw('svg', {viewBox: `0 0 ${w} ${h}`, role: 'img', 'aria-label': 'Counted operations a frame over error, a point each policy'});
  const show = (v) => v >= 1e4 || v < 1e-3 ? v.toExponential(0) : String(Number(v.toPrecision(1)));
  for (const v of x.marks) {
    svg.append(draw('line', {x1: x.at(v), x2: x.at(v), y1: 16, y2: h - pad}),
               draw('text', {x: x.at(v), y: h - pad + 18, 'text-anchor': 'middle'}, show(v)));
  }
  for (const v of y.marks) {
    svg.append(draw('line', {x1: pad, x2: w - 130, y1: y.at(v), y2: y.at(v)}),
               draw('text', {x: pad - 6, y: y.at(v) + 4, 'text-anchor': 'end'}, show(v)));
  }
  svg.append(draw('text', {x: (pad + w - 130) / 2, y: h - 16, 'text-anchor': 'middle'}, find('work-error').selectedOptions[0].text),
             draw('text', {x: 14, y: h / 2, transform: `rotate(-90 14 ${h / 2})`, 'text-anchor': 'middle'}, 'operations a frame'));
  // Names that would lie on each other move down.
  const taken = [];
  for (const p of points.sort((a, b) => y.at(a.y) - y.at(b.y))) {
    const [px, py] = [x.at(p.x), y.at(p.y)];
    const hollow = !(p.x > 0) || !(p.y > 0);
    svg.append(draw('circle', {cx: px, cy: py, r: 4.5, fill: hollow ? 'none' : p.color, stroke: p.color, 'stroke-width': 1.5}));
    let ty = py + 4;
    while (taken.some(([tx, t]) => Math.abs(tx - px) < 120 && Math.abs(t - ty) < 13)) ty += 3;
    taken.push([px, ty]);
    svg.append(draw('text', {x: px + 8, y: ty}, p.run.label));
  }
  find('work').replaceChildren(svg);
  if (left.length) find('work').append(make('p', {className: 'note', textContent: `Without a value: ${left.join(', ')}.`}));
}

// --- the scene from above
function drawView() {
  const view = data.views[find('view').value], canvas = find('map'), context = canvas.getContext('2d');
  const k = Number(find('view-frame').value), frame = view.frames[k];
  const [w, h] = [canvas.width, canvas.height];
  const [x0, z0, x1, z1] = view.bounds;
  const scale = Math.min((w - 30) / Math.max(x1 - x0, 1e-9), (h - 30) / Math.max(z1 - z0, 1e-9));
  const X = (x) => w / 2 + (x - (x0 + x1) / 2) * scale, Z = (z) => h / 2 + (z - (z0 + z1) / 2) * scale;
  context.clearRect(0, 0, w, h);
  context.fillStyle = css('--line');
  for (let i = 0; i < view.x.length; ++i) context.fillRect(X(view.x[i]) - 1, Z(view.z[i]) - 1, 2, 2);
  context.strokeStyle = css('--soft'); context.lineWidth = 1.5;
  context.beginPath();
  view.path.forEach(([x, z], i) => i ? context.lineTo(X(x), Z(z)) : context.moveTo(X(x), Z(z)));
  context.stroke();
  const [ex, ez, heading, half] = frame.eye, reach = Math.hypot(w, h) / scale;
  context.fillStyle = css('--mark') + '22'; context.strokeStyle = css('--mark');
  context.beginPath(); context.moveTo(X(ex), Z(ez));
  for (const side of [-half, half]) context.lineTo(X(ex + reach * Math.sin(heading + side)), Z(ez - reach * Math.cos(heading + side)));
  context.closePath(); context.fill(); context.stroke();
  frame.items.forEach(([i, share]) => {  // share: -1 not drawn, else 0 coarsest .. 1 finest
    context.fillStyle = share < 0 ? '#888888' : `hsl(${20 + 110 * share} 75% 42%)`;
    context.beginPath(); context.arc(X(view.x[i]), Z(view.z[i]), share < 0 ? 2 : 2.5 + 2 * share, 0, 7); context.fill();
  });
  context.fillStyle = css('--mark');
  context.beginPath(); context.arc(X(ex), Z(ez), 5, 0, 7); context.fill();
  find('view-number').textContent = `${frame.frame}`;
  find('view-note').textContent = `${view.title}. Orange is the coarsest level, green the finest, grey is not drawn; faint dots are out of view. ` +
      `${frame.items.length} items in view${view.thinned ? `, one object in ${view.thinned} drawn` : ''}.`;
}

function makeViews() {
  if (!data.views.length) { find('view-section').remove(); return; }
  find('view').append(...data.views.map((v, i) => make('option', {value: i, textContent: v.scene})));
  const reset = () => { find('view-frame').max = data.views[find('view').value].frames.length - 1; find('view-frame').value = 0; drawView(); };
  find('view').onchange = reset;
  find('view-frame').oninput = drawView;
  reset();
}

makeTable();
find('block').append(...data.blocks.map((b, i) => make('option', {value: i, textContent: b.title})));
find('block').onchange = () => chooseBlock(Number(find('block').value));
find('run').onchange = drawMix;
find('work-error').onchange = () => drawWork(data.blocks[find('block').value]);
for (const button of document.querySelectorAll('[data-zoom]')) button.onclick = () => zoomTo(...kZooms[button.dataset.zoom](range));
if (data.blocks.length) chooseBlock(0);
makeViews();
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  drawBlock(data.blocks[find('block').value]);
  if (data.views.length) drawView();
});
})();

'use strict';
// Everything from the file reaches the page as text (textContent) or as a number; never as markup.
const root = document.documentElement;
addEventListener('error', e => { root.dataset.error = e.message || 'a resource did not load'; });
addEventListener('securitypolicyviolation', e => { root.dataset.blocked = e.violatedDirective; });

const $ = id => document.getElementById(id);
const data = JSON.parse($('data').textContent);

function make(tag, options = {}, ...children) {
  const node = document.createElement(tag);
  for (const [key, value] of Object.entries(options)) {
    if (key === 'class') node.className = value;
    else if (key.startsWith('on')) node.addEventListener(key.slice(2), value);
    else if (key in node) node[key] = value;
    else node.setAttribute(key, value);
  }
  node.append(...children);
  return node;
}
function draw(tag, attributes = {}, ...children) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}
const grouped = n => n.toLocaleString('en-US');
const short = n => n === null ? 'not finite' : Math.abs(n) < 5e-7 ? '0' : String(+n.toPrecision(4));
const shorts = list => list.map(short).join('  ');
const plural = (n, word) => `${grouped(n)} ${word}${n === 1 ? '' : 's'}`;
function bytesText(n) {
  if (n < 1024) return `${n} B`;
  const power = Math.min(4, Math.floor(Math.log2(n) / 10));
  return `${(n / 2 ** (10 * power)).toFixed(n / 2 ** (10 * power) < 10 ? 1 : 0)} ${['', 'KiB', 'MiB', 'GiB', 'TiB'][power]}`;
}
const shareText = share => share >= 0.0995 ? `${Math.round(share * 100)} %` : `${(share * 100).toPrecision(2)} %`;
const quoted = (name, otherwise) => name ? name : otherwise;
const show = id => { $(id).hidden = false; return $(id); };

/** Depths and subtree ends of nodes in pre-order; parents[n] < n, -1 for roots. */
function shape(parents) {
  const count = parents.length, depth = new Int32Array(count), end = new Int32Array(count);
  for (let n = 0; n < count; ++n) { depth[n] = parents[n] < 0 ? 0 : depth[parents[n]] + 1; end[n] = n + 1; }
  for (let n = count - 1; n >= 0; --n) if (parents[n] >= 0) end[parents[n]] = Math.max(end[parents[n]], end[n]);
  return { count, parents, depth, end };
}

/** A tree with folding, search and keys. view: { label, head, cells(n), text(n), open(n), pick(n) } */
function outline(host, nodes, view) {
  const most = 1000, { count, parents, depth, end } = nodes;
  const isOpen = new Uint8Array(count), isMatch = new Uint8Array(count);
  let from = 0, current = 0, query = '', shown = [];
  for (let n = 0; n < count; ++n) isOpen[n] = view.open(n) ? 1 : 0;

  const status = make('span', { class: 'quiet', role: 'status' });
  const search = make('input', { type: 'search', placeholder: 'Search', 'aria-label': `Search the ${view.label}` });
  const setAll = value => { isOpen.fill(value); from = 0; render(); };
  const earlier = make('button', { onclick: () => move(-most) }, 'Earlier rows');
  const later = make('button', { onclick: () => move(most) }, 'Later rows');
  const rows = make('div', { class: 'rows', role: 'tree', 'aria-label': view.label });
  host.replaceChildren(make('div', { class: 'bar' }, search,
    make('button', { onclick: () => setAll(1) }, 'Unfold all'), make('button', { onclick: () => setAll(0) }, 'Fold all'),
    earlier, later, status), rows);

  function visible() {
    const list = [];
    for (let n = 0; n < count;) {
      if (query && !isMatch[n]) { n = end[n]; continue; }
      list.push(n);
      n = isOpen[n] || query ? n + 1 : end[n];
    }
    return list;
  }
  function render(focus) {
    shown = visible();
    if (!shown.includes(current)) current = shown.length ? shown[0] : 0;
    if (focus) from = Math.floor(shown.indexOf(current) / most) * most;
    from = Math.max(0, Math.min(from, shown.length - 1));
    rows.replaceChildren(make('div', { class: 'row head', role: 'presentation' }, ...view.head()));
    for (const n of shown.slice(from, from + most)) rows.append(row(n));
    earlier.hidden = later.hidden = shown.length <= most;
    earlier.disabled = from === 0;
    later.disabled = from + most >= shown.length;
    status.textContent = shown.length > most
      ? `rows ${grouped(from + 1)} to ${grouped(Math.min(from + most, shown.length))} of ${grouped(shown.length)}` : '';
    if (query) status.textContent = `${plural(hits, 'match').replace('matchs', 'matches')} ${status.textContent}`;
    const node = focus && rows.querySelector('[tabindex="0"]');
    if (node) { node.focus({ preventScroll: true }); node.scrollIntoView({ block: 'nearest' }); }
  }
  function row(n) {
    const holds = end[n] > n + 1, unfolded = isOpen[n] || query;
    const node = make('div', { class: `row ${view.kind ? view.kind(n) : ''}`, role: 'treeitem', 'aria-level': depth[n] + 1,
      tabIndex: n === current ? 0 : -1, onclick: () => { current = n; if (holds) isOpen[n] ^= 1; render(true); view.pick(n); } });
    if (holds) node.setAttribute('aria-expanded', unfolded ? 'true' : 'false');
    const cells = view.cells(n);
    cells.main.prepend(make('span', { class: 'fold', 'aria-hidden': 'true' }, holds ? (unfolded ? '\u25be' : '\u25b8') : ''));
    cells.main.style.paddingLeft = `${Math.min(depth[n], 14) * 0.9}rem`;
    if (depth[n] > 14) cells.main.prepend(`[${depth[n]}] `);
    node.append(...cells.all);
    return node;
  }
  function move(step) { from = Math.max(0, from + step); current = shown[Math.min(from, shown.length - 1)]; render(true); }
  let hits = 0;
  search.addEventListener('input', () => {
    query = search.value.trim().toLowerCase();
    isMatch.fill(0);
    hits = 0;
    for (let n = count - 1; query && n >= 0; --n) {
      if (view.text(n).toLowerCase().includes(query)) { isMatch[n] = 1; ++hits; }
      if (isMatch[n] && parents[n] >= 0) isMatch[parents[n]] = 1;
    }
    from = 0;
    render();
  });
  rows.addEventListener('keydown', e => {
    const at = shown.indexOf(current);
    const go = { ArrowDown: shown[at + 1], ArrowUp: shown[at - 1], Home: shown[0], End: shown[shown.length - 1] };
    if (e.key in go) { if (go[e.key] !== undefined) current = go[e.key]; }
    else if (e.key === 'ArrowRight') { if (!isOpen[current]) isOpen[current] = 1; else if (end[current] > current + 1) ++current; }
    else if (e.key === 'ArrowLeft') { if (isOpen[current] && end[current] > current + 1) isOpen[current] = 0; else if (parents[current] >= 0) current = parents[current]; }
    else if (e.key === 'Enter' || e.key === ' ') view.pick(current);
    else return;
    e.preventDefault();
    render(true);
  });
  render();
  return function reveal(n) {
    query = search.value = '';
    for (let p = parents[n]; p >= 0; p = parents[p]) isOpen[p] = 1;
    current = n;
    render(true);
  };
}

// The character

function pictureSection() {
  const { list, leftOut, whyNone } = data.pictures;
  if (!list.length && !whyNone) return;
  show('pictures');
  document.querySelector('.pictures').replaceChildren(...list.map((picture, i) => {
    const name = picture.clip ? quoted(picture.name, `clip ${i - 1}`) : 'At rest';
    const image = make('img', { alt: picture.clip ? `The character in its clip ${name}` : 'The character at rest', src: picture.src });
    image.addEventListener('error', e => { e.stopPropagation(); image.remove(); });
    return make('figure', {}, image, make('figcaption', {}, name));
  }));
  $('picturenote').textContent = list.length ? (leftOut ? `${plural(leftOut, 'more clip')} in the file.` : '') : `No pictures: ${whyNone}.`;
}

// Chunks

const families = { joint: 'joints', rig: 'constraints, IK', mesh: 'geometry', anim: 'animation', image: 'textures', look: 'materials', rest: 'other' };
const familyOf = {};
for (const [family, ids] of Object.entries({
  joint: 'SKIN PIVO REST', rig: 'LIMT PULL IKCH KINF', mesh: 'VECT VINF PALT TARG TINF POSI NORM TANG TEXC COLR BONE WGHT USER VALS INDX POLY LODD',
  anim: 'CYCL CINF TRAK PACK TIME KEYV MARK', image: 'TEXT SAMP IMAG LINK SAME', look: 'MATE SURF' })) for (const id of ids.split(' ')) familyOf[id] = family;

const chunks = data.chunks;
let nodes, revealChunk = () => {}, zoom = () => {};
const idOf = n => chunks.ids[chunks.id[n]];
const kindOf = n => familyOf[idOf(n)] || (chunks.parent[n] > 0 ? familyOf[idOf(chunks.parent[n])] : '') || 'rest';
const bytesOf = n => 16 + Math.ceil(chunks.size[n] / 16) * 16;
const steps = [];
function stepOf(n) { return idOf(n) + (steps[n] ? `[${steps[n]}]` : ''); }
function pathOf(n, whole) {
  const path = [];
  for (; n >= 0; n = chunks.parent[n]) path.push(stepOf(n));
  path.reverse();
  return (whole || path.length <= 12 ? path : [...path.slice(0, 5), `... ${path.length - 10} more ...`, ...path.slice(-5)]).join('/');
}
const encodingOf = n => chunks.encoded[n] || (nodes.end[n] > n + 1 ? 'container' : 'raw');
const goTo = n => make('button', { class: 'link mono', onclick: () => { $('tree').scrollIntoView(); revealChunk(n); } }, pathOf(n));

function childrenOf(n) {
  const list = [];
  for (let child = n + 1; child < nodes.end[n]; child = nodes.end[child]) list.push(child);
  return list;
}

/** Squarified treemap (Bruls, Huizing, van Wijk 2000): calls place(item, x, y, w, h); items by falling size. */
function squarify(items, x, y, w, h, place) {
  let left = items.reduce((sum, item) => sum + item.size, 0);
  for (let at = 0; at < items.length && left > 0;) {
    const side = Math.min(w, h), scale = w * h / left;
    let sum = 0, worst = Infinity, last = at;
    for (; last < items.length; ++last) {
      const next = sum + items[last].size, length = next * scale / side;
      const ratio = Math.max(items[at].size * scale / length / length, length * length / (items[last].size * scale));
      if (ratio > worst) break;
      worst = ratio;
      sum = next;
    }
    const thick = sum * scale / side;
    let along = 0;
    for (; at < last; ++at) {
      const length = items[at].size * scale / thick;
      if (w >= h) place(items[at], x, y + along, thick, length);
      else place(items[at], x + along, y, length, thick);
      along += length;
    }
    if (w >= h) { x += thick; w -= thick; } else { y += thick; h -= thick; }
    left -= sum;
  }
}

function chunkMap() {
  const map = $('map'), info = $('mapinfo'), mostCells = 1500;
  let top = 0, cells = [];
  function tell(item) {
    const text = item.rest ? `${pathOf(item.n)}: ${item.rest}` : `${pathOf(item.n)} ${chunks.text[item.n]}`;
    info.textContent = `${text} \u00b7 ${grouped(item.size)} bytes with header and padding \u00b7 ${shareText(item.size / data.bytes)} of the file \u00b7 ${item.rest ? '' : encodingOf(item.n)}`;
  }
  function choose(item) {
    if (!item.rest && nodes.end[item.n] === item.n + 1) revealChunk(item.n);
    else if (item.n !== top) zoom(item.n, true);
  }
  function cell(item, x, y, w, h, holds) {
    const node = make('button', { class: `cell ${kindOf(item.n)}${holds ? ' holder' : ''}`, tabIndex: cells.length ? -1 : 0,
      onclick: () => choose(item), onmouseenter: () => tell(item), onfocus: () => tell(item) });
    Object.assign(node.style, { left: `${x}px`, top: `${y}px`, width: `${w}px`, height: `${h}px` });
    const label = item.rest ? item.rest : stepOf(item.n) + (holds && w > 120 ? ' ' + chunks.text[item.n] : '');
    if (w > 34 && h > 15) node.textContent = label;
    else node.setAttribute('aria-label', label);
    cells.push(node);
    map.append(node);
  }
  function inside(n, w, h) {
    const items = [], crumbs = { n, size: 0, count: 0 }, unit = w * h / bytesOf(n);
    let listed = 16;
    for (const child of childrenOf(n)) {
      const size = bytesOf(child);
      listed += size;
      if (size * unit < 12) { crumbs.size += size; ++crumbs.count; } else items.push({ n: child, size });
    }
    const missing = bytesOf(n) - listed;
    if (nodes.end[n] > n + 1 && chunks.total > nodes.count && missing > 0) { crumbs.size += missing; crumbs.rest = 'smaller chunks, and chunks that this page does not list'; }
    if (crumbs.size) items.push({ n, size: crumbs.size, rest: crumbs.rest || `${grouped(crumbs.count)} smaller` });
    return items.sort((a, b) => b.size - a.size);
  }
  function layout() {
    const width = map.clientWidth, height = map.clientHeight;
    map.replaceChildren();
    cells = [];
    const open = [{ n: top, size: bytesOf(top), x: 0, y: 0, w: width, h: height }];
    for (let at = 0; at < open.length && cells.length < mostCells; ++at) {
      const { x, y, w, h, ...item } = open[at];
      const holds = !item.rest && nodes.end[item.n] > item.n + 1;
      const nests = holds && w > 40 && h > 40;
      cell(item, x, y, w, h, nests);
      if (nests) squarify(inside(item.n, w - 6, h - 22), x + 3, y + 19, w - 6, h - 22, (child, cx, cy, cw, ch) => open.push({ ...child, x: cx, y: cy, w: cw, h: ch }));
    }
  }
  function trail() {
    const path = [];
    for (let n = top; n >= 0; n = chunks.parent[n]) path.unshift(n);
    const ends = path.length > 9 ? [...path.slice(0, 4), null, ...path.slice(-4)] : path;
    $('trail').replaceChildren(...ends.flatMap((n, i) => [i ? '/' : '', n === null ? '...' : make('button', { onclick: () => zoom(n, true), disabled: n === top }, stepOf(n))]));
  }
  zoom = (n, focus) => {
    top = n;
    trail();
    layout();
    tell({ n, size: bytesOf(n) });
    if (focus && cells[0]) cells[0].focus({ preventScroll: true });
  };
  map.addEventListener('keydown', e => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[e.key];
    if (step) {
      const at = cells.indexOf(document.activeElement), next = cells[(at + step + cells.length) % cells.length];
      if (at >= 0) cells[at].tabIndex = -1;
      next.tabIndex = 0;
      next.focus();
    } else if (e.key === 'Escape' || e.key === 'Backspace') { if (top > 0) zoom(chunks.parent[top], true); }
    else return;
    e.preventDefault();
  });
  new ResizeObserver(layout).observe(map);
  $('legend').replaceChildren(...Object.entries(families).map(([kind, name]) => make('span', { class: `key ${kind}` }, make('i'), name)),
    chunks.total > nodes.count ? `The page lists the first ${grouped(nodes.count)} of ${grouped(chunks.total)} chunks.` : '');
  zoom(0);
}

function chunkSection() {
  nodes = shape(chunks.parent);
  const seen = new Map();
  for (let n = 0; n < nodes.count; ++n) {
    const key = `${chunks.parent[n]} ${chunks.id[n]}`;
    steps.push(seen.get(key) || 0);
    seen.set(key, steps[n] + 1);
  }
  show('chunks');
  chunkMap();
  const roomy = nodes.count <= 60;
  revealChunk = outline($('tree'), nodes, {
    label: 'chunks', kind: kindOf,
    head: () => [make('span', { class: 'num' }, 'offset'), make('span', { class: 'num' }, 'bytes'), make('span', { class: 'main' }, 'chunk'), 'content'],
    cells: n => {
      const main = make('span', { class: 'main', title: `${pathOf(n)}: ${chunks.meanings[chunks.id[n]]}` }, make('b', { class: 'mono' }, stepOf(n)), ` ${chunks.meanings[chunks.id[n]]}`);
      return { main, all: [make('span', { class: 'num' }, grouped(chunks.offset[n])), make('span', { class: 'num' }, grouped(chunks.size[n])), main, make('span', { class: 'text' }, chunks.text[n])] };
    },
    text: n => `${idOf(n)} ${chunks.meanings[chunks.id[n]]} ${chunks.text[n]}`,
    open: n => roomy || n === 0 || idOf(n) === 'OBJE',
    pick: n => { if (nodes.end[n] > n + 1) zoom(n); },
  });
}

// Skeleton

let skeleton = null;
const jointName = n => quoted(skeleton.joints.name[n], `joint ${n}`);
function turnText(q) {
  if (q.includes(null)) return 'not finite';
  const sine = Math.hypot(q[0], q[1], q[2]);
  if (sine < 1e-6) return '0\u00b0';
  const degrees = 2 * Math.atan2(sine, Math.abs(q[3])) * 180 / Math.PI, sign = q[3] < 0 ? -1 : 1;
  return `${short(degrees)}\u00b0 about ${shorts([0, 1, 2].map(i => +(sign * q[i] / sine).toFixed(2)))}`;
}

const camera = { yaw: 0.55, pitch: 0.25, zoom: 1 };
let bones = [], pickedJoint = -1, pickedChain = null, hovered = -1, revealJoint = () => {};

function drawBones() {
  const canvas = $('bones'), ratio = devicePixelRatio || 1, w = canvas.clientWidth, h = canvas.clientHeight;
  if (!skeleton || !w) return;
  canvas.width = w * ratio;
  canvas.height = h * ratio;
  const pen = canvas.getContext('2d'), style = getComputedStyle(root), colour = name => style.getPropertyValue(`--${name}`);
  pen.scale(ratio, ratio);
  const places = skeleton.joints.place.map(p => p.includes(null) ? null : p);
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const p of places) if (p) for (let i = 0; i < 3; ++i) { low[i] = Math.min(low[i], p[i]); high[i] = Math.max(high[i], p[i]); }
  const middle = low.map((v, i) => (v + high[i]) / 2), [dx, dy, dz] = low.map((v, i) => high[i] - v);
  const wide = Math.hypot(dx, dz), scale = 0.88 * Math.min(w / (wide || 1e-6), h / (Math.hypot(dy, wide / 2) || 1e-6)) * camera.zoom;
  const [cy, sy, cp, sp] = [Math.cos(camera.yaw), Math.sin(camera.yaw), Math.cos(camera.pitch), Math.sin(camera.pitch)];
  const turned = ([x, y, z]) => { const side = cy * x - sy * z, depth = sy * x + cy * z; return [side, cp * y - sp * depth]; };
  const project = p => { const [x, y] = turned(p.map((v, i) => v - middle[i])); return [w / 2 + scale * x, h / 2 - scale * y]; };
  bones = places.map(p => p && project(p));
  const inChain = new Set(pickedChain || []);
  const line = (a, b, name, width) => { pen.strokeStyle = colour(name); pen.lineWidth = width; pen.beginPath(); pen.moveTo(...a); pen.lineTo(...b); pen.stroke(); };
  const parents = skeleton.joints.parent;
  for (let n = 0; n < bones.length; ++n) {
    if (!bones[n] || parents[n] < 0 || !bones[parents[n]]) continue;
    const strong = inChain.has(n) && inChain.has(parents[n]);
    line(bones[parents[n]], bones[n], strong ? 'image' : 'rest', strong ? 4 : 1.4);
  }
  const dot = bones.length > 2000 ? 1.5 : bones.length > 200 ? 2.4 : 3.4;
  for (let n = 0; n < bones.length; ++n) {
    if (!bones[n]) continue;
    const [x, y] = bones[n];
    pen.beginPath();
    if (skeleton.joints.constraints[n]) {
      pen.fillStyle = colour('anim');
      pen.rect(x - dot, y - dot, 2 * dot, 2 * dot);
    } else {
      pen.fillStyle = colour('joint');
      pen.arc(x, y, dot, 0, 7);
    }
    pen.fill();
    if (n !== pickedJoint && n !== hovered) continue;
    pen.strokeStyle = colour('ink');
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.arc(x, y, dot + 4, 0, 7);
    pen.stroke();
  }
  pen.font = '11px system-ui, sans-serif';
  ['X', 'Y', 'Z'].forEach((name, i) => {
    const [x, y] = turned([0, 1, 2].map(k => k === i ? 26 : 0)), start = [40, h - 40];
    line(start, [start[0] + x, start[1] - y], 'quiet', 1.2);
    pen.fillStyle = colour('quiet');
    pen.fillText(name, start[0] + x * 1.25 - 3, start[1] - y * 1.25 + 4);
  });
}
function tellBone(n) {
  const joints = skeleton.joints;
  $('boneinfo').textContent = n < 0 ? '' : `${jointName(n)} \u00b7 joint ${n} \u00b7 at ${shorts(joints.place[n])} m${joints.constraints[n] ? ` \u00b7 ${joints.constraints[n]}` : ''}`;
}
function boneView() {
  const canvas = $('bones');
  let held = null, travelled = 0;
  const near = e => {
    const box = canvas.getBoundingClientRect(), x = e.clientX - box.left, y = e.clientY - box.top;
    let best = -1, least = 14 * 14;
    bones.forEach((p, n) => { if (!p) return; const d = (p[0] - x) ** 2 + (p[1] - y) ** 2; if (d < least) { least = d; best = n; } });
    return best;
  };
  canvas.addEventListener('pointerdown', e => { held = [e.clientX, e.clientY]; travelled = 0; canvas.setPointerCapture(e.pointerId); });
  canvas.addEventListener('pointermove', e => {
    if (held) {
      const dx = e.clientX - held[0], dy = e.clientY - held[1];
      travelled += Math.abs(dx) + Math.abs(dy);
      camera.yaw += dx * 0.01;
      camera.pitch = Math.max(-1.57, Math.min(1.57, camera.pitch + dy * 0.01));
      held = [e.clientX, e.clientY];
    } else { hovered = near(e); tellBone(hovered < 0 ? pickedJoint : hovered); }
    drawBones();
  });
  canvas.addEventListener('pointerup', e => { held = null; const n = near(e); if (travelled < 4 && n >= 0) { pickedJoint = n; revealJoint(n); tellBone(n); drawBones(); } });
  canvas.addEventListener('wheel', e => { e.preventDefault(); zoomBy(Math.exp(-e.deltaY * 0.0015)); }, { passive: false });
  canvas.addEventListener('keydown', e => {
    const turn = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[e.key];
    if (turn) { camera.yaw += turn[0]; camera.pitch = Math.max(-1.57, Math.min(1.57, camera.pitch + turn[1])); drawBones(); }
    else if (e.key === '+' || e.key === '=') zoomBy(1.15);
    else if (e.key === '-') zoomBy(1 / 1.15);
    else return;
    e.preventDefault();
  });
  const zoomBy = factor => { camera.zoom = Math.max(0.1, Math.min(200, camera.zoom * factor)); drawBones(); };
  new ResizeObserver(drawBones).observe(canvas);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', drawBones);
}

function skeletonSection(object) {
  skeleton = object;
  pickedJoint = hovered = -1;
  pickedChain = null;
  const { joints, chains } = object, tree = shape(joints.parent), scaled = s => s.some(v => v !== 1);
  const num = (text, slim) => make('span', { class: `num wide ${slim || ''}` }, text);
  revealJoint = outline($('joints'), tree, {
    label: 'joints',
    head: () => [make('span', { class: 'main' }, 'joint'), num('translation, m'), num('rotation'), num('scale', 'slim'), 'constraints'],
    cells: n => {
      const main = make('span', { class: 'main' }, make('span', { class: 'quiet' }, `${n} `), jointName(n));
      const turn = num(turnText(joints.r[n]));
      turn.title = `quaternion ${shorts(joints.r[n])}`;
      return { main, all: [main, num(shorts(joints.t[n])), turn, num(scaled(joints.s[n]) ? shorts(joints.s[n]) : '1', 'slim'), make('span', { class: 'text' }, joints.constraints[n])] };
    },
    text: n => `${jointName(n)} ${joints.constraints[n]}`,
    open: () => tree.count <= 400,
    pick: n => { pickedJoint = n; tellBone(n); drawBones(); },
  });
  $('chains').hidden = !chains.total;
  $('chains').lastElementChild.replaceChildren(...chains.list.map((chain, i) => make('li', {},
    make('button', { class: 'link', 'aria-pressed': 'false', onclick: e => {
      const on = pickedChain !== chain.links;
      for (const button of $('chains').querySelectorAll('button')) button.setAttribute('aria-pressed', 'false');
      e.target.setAttribute('aria-pressed', on);
      pickedChain = on ? chain.links : null;
      drawBones();
    } }, quoted(chain.name, `chain ${i}`)),
    make('div', { class: 'quiet' }, chain.text))));
  const limited = joints.constraints.filter(text => text).length;
  $('bonelegend').replaceChildren(make('span', { class: 'key joint' }, make('i'), 'joint'), limited ? make('span', { class: 'key anim' }, make('i'), 'joint with constraints') : '',
    chains.total ? make('span', { class: 'key image' }, make('i'), 'chosen IK chain') : '',
    joints.total > tree.count ? `The page lists the first ${grouped(tree.count)} of ${grouped(joints.total)} joints. ` : '', 'Drag to turn, wheel to zoom.');
  tellBone(-1);
  drawBones();
}

// Clips

const pathNames = ['Translation', 'Rotation', 'Scale', 'Weights of morph targets'];
const interpolations = ['step', 'linear', 'cubic'];
/** A quaternion and its negative turn alike: takes the sign that is nearer to the one before, so that curves do not leap. */
function unleaped(values) {
  const out = values.map(list => list.slice());
  for (let k = 1; k < out[0].length; ++k) {
    const dot = out.reduce((sum, list) => sum + list[k] * list[k - 1], 0);
    if (dot < 0) for (const list of out) list[k] = -list[k];
  }
  return out;
}
/** The rotation vectors of unleaped quaternions: degrees about x, y and z. */
function inDegrees(values) {
  const out = [[], [], []];
  values[0].forEach((_, k) => {
    const q = values.map(list => list[k]), sine = Math.hypot(q[0], q[1], q[2]), angle = 2 * Math.atan2(sine, q[3]) * 180 / Math.PI;
    out.forEach((list, c) => list.push(q.includes(null) ? null : sine > 0 ? angle * q[c] / sine : 0));
  });
  return out;
}
function ticks(low, high, most) {
  const raw = (high - low) / most || 1, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map(m => m * power).find(s => s >= raw) || raw, list = [];
  for (let v = Math.ceil(low / step) * step; v <= high + step * 1e-6 && list.length < 20; v += step) list.push(+v.toPrecision(10));
  return list;
}
function legendLine(c) { return draw('svg', { viewBox: '0 0 28 10' }, draw('line', { class: `curve c${c % 4}`, x1: 0, x2: 28, y1: 5, y2: 5 })); }

/** Of a list of numbers and nulls: a range that shows how they change, with some room; null if they do not. */
function rangeOf(lists) {
  let low = Infinity, high = -Infinity;
  for (const v of lists.flat()) if (v !== null) { low = Math.min(low, v); high = Math.max(high, v); }
  const moves = high - low > Math.max(Math.abs(low), Math.abs(high)) * 1e-5 + 1e-9;
  const room = moves ? (high - low) * 0.08 : Math.max(Math.abs(low), Math.abs(high)) * 0.1 || 1;
  return low <= high ? { low: low - room, high: high + room, size: high - low, moves } : { low: 0, high: 1, size: 0, moves: false };
}
/** Curves that share an axis: all, or each moving one by itself where one axis would flatten them. */
function bandsOf(values) {
  const all = { ...rangeOf(values), curves: values.map((_, c) => c) };
  const single = values.map((list, c) => ({ ...rangeOf([list]), curves: [c] })).filter(range => range.moves);
  const flattens = single.some(range => all.size > 3 * range.size);
  return single.length && single.length <= 4 && flattens ? single : [all];
}

function chart(clip, track) {
  const turns = track.path === 1, degrees = turns && $('degrees').checked;
  const times = data.times[track.times], raw = turns ? unleaped(track.values) : track.values, values = degrees ? inDegrees(raw) : raw;
  const names = track.path === 3 ? values.map((_, c) => quoted((track.names || [])[c], `target ${c}`)) : ['x', 'y', 'z', 'w'];
  const bands = bandsOf(values);
  const start = Math.min(times[0], clip.start ?? times[0]), end = Math.max(times[times.length - 1], clip.end ?? start, start + 1e-6);
  const info = make('span', { class: 'readout quiet' });
  const svg = draw('svg', { class: 'chart', tabindex: 0, role: 'img', 'aria-label': `${pathNames[track.path]} over time. Left and right arrow keys read values.` });
  let x = () => 0;
  let at = -1;
  const cursor = draw('line', { class: 'cursor', visibility: 'hidden' });
  if (bands.length > 1) svg.style.height = `${1.5 + 5.5 * bands.length}rem`;
  function layout() {
    const w = svg.clientWidth, h = svg.clientHeight, left = 62, right = 14, top = 10, bottom = 24;
    if (!w) return;
    x = t => left + (t - start) / (end - start) * (w - left - right);
    const gap = 10, tall = (h - top - bottom - gap * (bands.length - 1)) / bands.length;
    const scales = bands.map(({ low, high }, i) => v => top + i * (tall + gap) + (high - v) / (high - low) * tall);
    svg.setAttribute('viewBox', `0 0 ${w} ${h}`);
    svg.replaceChildren();
    bands.forEach(({ low, high }, i) => {
      for (const v of ticks(low, high, bands.length > 1 ? 2 : 4)) {
        const level = scales[i](v);
        svg.append(draw('line', { class: 'grid', x1: left, x2: w - right, y1: level, y2: level }), draw('text', { x: left - 8, y: level + 4, 'text-anchor': 'end' }, short(v)));
      }
      if (bands.length > 1) svg.append(draw('text', { x: 8, y: scales[i]((low + high) / 2) + 4 }, names[bands[i].curves[0]]));
    });
    for (const t of ticks(start, end, 8)) svg.append(draw('line', { class: 'grid', x1: x(t), x2: x(t), y1: top, y2: h - bottom }), draw('text', { x: x(t), y: h - 7, 'text-anchor': 'middle' }, `${short(t)} s`));
    for (const [t, name] of clip.markers) if (t !== null) svg.append(draw('line', { class: 'marker', x1: x(t), x2: x(t), y1: top, y2: h - bottom }), draw('text', { class: 'marker', x: x(t) + 3, y: top + 9 }, name));
    bands.forEach((band, i) => band.curves.forEach(c => {
      const list = values[c], y = scales[i];
      let path = '', pen = 'M', before = 0;
      list.forEach((v, k) => {
        if (v === null || times[k] === null) { pen = 'M'; return; }
        const px = x(times[k]).toFixed(1), py = y(v).toFixed(1);
        if (track.interpolation === 0 && pen === 'L') path += `L${px} ${before}`;
        path += `${pen}${px} ${py}`;
        pen = 'L';
        before = py;
      });
      svg.append(draw('path', { class: `curve c${c % 4}`, d: path || 'M0 0' }));
    }));
    cursor.setAttribute('y1', top);
    cursor.setAttribute('y2', h - bottom);
    svg.append(cursor);
  }
  function read(k) {
    at = Math.max(0, Math.min(times.length - 1, k));
    cursor.setAttribute('x1', x(times[at]));
    cursor.setAttribute('x2', x(times[at]));
    cursor.setAttribute('visibility', 'visible');
    info.textContent = `${short(times[at])} s: ${values.map((list, c) => `${names[c]} ${short(list[at])}`).join('   ')}`;
  }
  svg.addEventListener('pointermove', e => {
    const px = e.clientX - svg.getBoundingClientRect().left;
    let best = 0;
    times.forEach((t, k) => { if (Math.abs(x(t) - px) < Math.abs(x(times[best]) - px)) best = k; });
    read(best);
  });
  svg.addEventListener('keydown', e => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
    if (step) { e.preventDefault(); read(at + step); }
  });
  const unit = track.path === 0 ? ', m' : degrees ? ', degrees about x, y, z together' : turns ? ', quaternion' : '';
  const more = track.components > raw.length ? `, the first ${raw.length} of ${track.components}` : '';
  const figure = make('figure', {}, make('h3', {}, `${pathNames[track.path]}${unit}`, make('span', { class: 'quiet' }, ` \u00b7 ${plural(track.keys, 'key')}, ${interpolations[track.interpolation]}${more}`)), svg,
    make('figcaption', { class: 'quiet' }, ...values.map((list, c) => make('span', { class: 'key' }, legendLine(c), bands.some(band => band.curves.includes(c)) ? names[c] : `${names[c]} ${short(list[0])} throughout`)), info));
  new ResizeObserver(layout).observe(svg);
  return figure;
}

function clipSection(object) {
  const clips = object.clips.list, joints = object.joints.name;
  $('clip').replaceChildren(...clips.map((clip, i) => make('option', { value: i }, quoted(clip.name, `clip ${i}`))));
  let targets = [];
  const keyOf = track => track.path === 3 ? `mesh ${track.target}` : `joint ${track.target}`;
  const nameOf = track => track.path === 3 ? `targets of ${quoted(track.mesh, `mesh ${track.target}`)}` : quoted(joints[track.target], `joint ${track.target}`);
  function charts() {
    const clip = clips[$('clip').value], group = targets[$('target').value];
    $('charts').replaceChildren(...(group ? group.tracks.slice().sort((a, b) => a.path - b.path).map(track => chart(clip, track)) : []));
  }
  function choose() {
    const clip = clips[$('clip').value], groups = new Map(), kept = targets[$('target').value]?.key;
    for (const track of clip ? clip.tracks : []) {
      const key = keyOf(track);
      if (!groups.has(key)) groups.set(key, { key, name: nameOf(track), tracks: [] });
      groups.get(key).tracks.push(track);
    }
    targets = [...groups.values()];
    $('target').replaceChildren(...targets.map((group, i) => make('option', { value: i }, group.name)));
    $('target').value = Math.max(0, targets.findIndex(group => group.key === kept));
    $('clipinfo').textContent = clip ? `${short(clip.start)} to ${short(clip.end)} s, ${clip.loop ? 'repeats' : 'does not repeat'}, ${[...(clip.total || !clip.plays.length ? [plural(clip.total, 'track')] : []), ...clip.plays.map(play => `${plural(play.frames, 'frame')} of ${quoted(play.mesh, 'a mesh')} from frame ${play.first}${play.closed ? ', closed' : ''}`)].join(', ')}${clip.rate > 0 ? `, ${short(clip.rate)} frames/s` : ''}${clip.markers.length ? `, markers: ${clip.markers.map(([t, name]) => `${quoted(name, 'unnamed')} at ${short(t)} s`).join(', ')}` : ''}` : 'No clips.';
    charts();
  }
  $('clip').onchange = choose;
  $('target').onchange = $('degrees').onchange = charts;
  choose();
  const { points, thinned, leftOut } = data.curves;
  $('curvenote').textContent = 'Sampled through the runtime at the keys and, where curves bend, between them; the sign of quaternions is chosen so that they do not leap.'
    + (thinned ? ` ${plural(thinned, 'track')} with more than ${points} keys are drawn with ${points} points.` : '')
    + (leftOut ? ` ${plural(leftOut, 'track')} more are not on this page, which holds a bounded number of points.` : '');
}

// Textures and materials

function imageNodes(image, name) {
  if (image.same !== undefined) return [make('p', {}, `the image of texture ${image.same}`)];
  if (image.uri !== undefined) return [make('p', {}, `not in the file: ${image.uri}`)];
  const about = make('p', {}, `${image.media}, ${bytesText(image.bytes)}${image.why ? ` \u00b7 ${image.why}` : ''}`);
  if (!image.src) return [about];
  const picture = make('img', { alt: `Texture ${name}`, src: image.src });
  picture.addEventListener('load', () => { about.textContent += `, ${picture.naturalWidth} \u00d7 ${picture.naturalHeight}`; });
  picture.addEventListener('error', e => { e.stopPropagation(); picture.remove(); about.textContent += ' \u00b7 this browser cannot show it'; });
  return [picture, about];
}
const listNote = list => list.total > list.list.length ? [make('p', { class: 'quiet' }, `and ${grouped(list.total - list.list.length)} more`)] : [];
const materialName = n => quoted(data.materials.list[n]?.name, `material ${n}`);

function textureSection() {
  show('textures').lastElementChild.replaceChildren(...data.textures.list.map((texture, i) => {
    const name = quoted(texture.name, `texture ${i}`);
    return make('article', { class: 'card' }, make('h3', {}, make('span', { class: 'quiet' }, `${i} `), name), ...texture.images.flatMap(image => imageNodes(image, name)),
      make('p', { class: 'quiet' }, texture.sampler),
      make('p', {}, texture.uses.length ? `used by ${texture.uses.map(([material, slot]) => `${materialName(material)} (${slot})`).join(', ')}` : 'not used'));
  }), ...listNote(data.textures));
}
const srgb = v => Math.round(255 * Math.max(0, Math.min(1, v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055)));
function materialSection() {
  show('materials').lastElementChild.replaceChildren(...data.materials.list.map((material, i) => {
    const swatch = make('div', { class: 'swatch' });
    swatch.style.background = `rgb(${material.base.slice(0, 3).map(v => srgb(v ?? 0)).join(' ')})`;
    const flags = [material.alpha, material.doubleSided ? 'double-sided' : '', material.unlit ? 'unlit' : ''].filter(f => f).join(', ');
    const lines = [`base ${shorts(material.base)}`, `metallic ${short(material.metallic)}, roughness ${short(material.roughness)}`,
      material.emissive.some(v => v !== 0) ? `emissive ${shorts(material.emissive)}` : '', flags,
      ...material.textures.map(([slot, texture, coords]) => `${slot}: texture ${texture} ${data.textures.list[texture]?.name || ''}${coords ? `, coordinates ${coords}` : ''}`),
      material.extensions ? `extensions ${material.extensions}` : ''];
    return make('article', { class: 'card' }, swatch, make('h3', {}, make('span', { class: 'quiet' }, `${i} `), quoted(material.name, 'without a name')), ...lines.filter(l => l).map(l => make('p', {}, l)));
  }), ...listNote(data.materials));
}

// The page

function header() {
  document.title = `${data.file} - bendy inspect`;
  $('file').textContent = data.file;
  const faults = data.faults.total;
  $('verdict').textContent = faults ? `\u26a0 ${plural(faults, 'fault')}` : '\u2713 valid';
  $('verdict').classList.toggle('bad', faults > 0);
  $('about').textContent = `${grouped(data.bytes)} bytes${data.version ? `, ${data.version}` : ''}`;
  const facts = Object.entries({ ...(chunks ? { chunks: chunks.total } : {}), ...data.facts }).filter(([, n]) => n > 0);
  $('facts').replaceChildren(...facts.map(([name, n]) => make('div', {}, make('dt', {}, name), make('dd', {}, grouped(n)))));
  $('made').textContent = `Made by ${data.tool} inspect --html. This page loads nothing and runs nothing of the file.`;
}
function listSection(id, list, line) {
  if (!list || !list.total) return;
  show(id).lastElementChild.replaceChildren(...list.list.map(line), ...listNote(list));
}
function setUp() {
  header();
  if (data.pictures) pictureSection();
  if (chunks) chunkSection();
  listSection('faults', data.faults, fault => make('p', {}, make('code', {}, fault.code), ` ${fault.text} \u00b7 `,
    chunks && fault.chunk !== null ? goTo(fault.chunk) : make('code', {}, fault.path), ` \u00b7 offset ${grouped(fault.offset)}`));
  if (!chunks) {
    $('faults').append(make('p', {}, 'The grammar of the chunks is broken here, so nothing more of the file can be told.'));
    return;
  }
  listSection('warnings', data.warnings, warning => make('p', {}, `${warning.text} \u00b7 `, warning.chunk === null ? '' : goTo(warning.chunk)));
  const objects = data.objects, hasJoints = objects.some(o => o.joints.total), hasClips = objects.some(o => o.clips.total);
  if (hasJoints) { show('skeleton'); boneView(); }
  if (hasClips) show('clips');
  const choose = n => {
    for (const select of document.querySelectorAll('select.object')) select.value = n;
    if (hasJoints) skeletonSection(objects[n]);
    if (hasClips) clipSection(objects[n]);
  };
  for (const select of document.querySelectorAll('select.object')) {
    select.hidden = objects.length < 2;
    select.append(...objects.map((object, i) => make('option', { value: i }, quoted(object.name, `object ${i}`))));
    select.addEventListener('change', () => choose(+select.value));
  }
  if (objects.length) choose(0);
  if (data.textures.total) textureSection();
  if (data.materials.total) materialSection();
}
setUp();
$('nav').replaceChildren(...[...document.querySelectorAll('main > section:not([hidden])')].map(section => make('a', { href: `#${section.id}` }, section.querySelector('h2').firstChild.textContent.trim())));
root.dataset.ready = 'yes';

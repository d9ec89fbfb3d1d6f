'use strict';
(() => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const { width, height } = data;
  const $ = id => document.getElementById(id);

  // Every 16-bit float there is, once.
  const halves = new Float32Array(65536);
  for (let h = 0; h < 65536; ++h) {
    const exponent = h >> 10 & 31, fraction = h & 1023;
    const size = exponent === 0 ? fraction * 2 ** -24 : (1 + fraction / 1024) * 2 ** (exponent - 15);
    halves[h] = h & 0x8000 ? -size : size;
  }
  function decode(text) {
    const bytes = atob(text), values = new Float32Array(bytes.length / 2);
    for (let i = 0; i < values.length; ++i)
      values[i] = halves[bytes.charCodeAt(2 * i) | bytes.charCodeAt(2 * i + 1) << 8];
    return values;
  }
  const images = data.images.map(p => ({ name: p.name, rgb: decode(p.rgb) }));

  const state = { a: 0, b: Math.min(1, images.length - 1), mode: 'wipe', wipe: 0.5, showB: false,
    exposure: data.exposure, zoom: 1, zoomIsChosen: false, scale: 0, scaleIsChosen: false };

  // Linear SMPTE-C to the codes of an sRGB display (IEC 61966-2-1).
  const m = data.srgb_from_smpte;
  function code(v) {
    const x = Math.min(1, Math.max(0, v));
    return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
  }
  function shown(image) {
    const out = new ImageData(width, height), gain = 2 ** state.exposure, p = image.rgb;
    for (let i = 0; i < width * height; ++i) {
      for (let c = 0; c < 3; ++c)
        out.data[4 * i + c] = code(gain * (m[3 * c] * p[3 * i] + m[3 * c + 1] * p[3 * i + 1] + m[3 * c + 2] * p[3 * i + 2]));
      out.data[4 * i + 3] = 255;
    }
    return out;
  }

  const luminance = (p, i) => 0.2124 * p[3 * i] + 0.7011 * p[3 * i + 1] + 0.0866 * p[3 * i + 2];
  // Blue, white, red: ends that people of any colour vision tell apart.
  const ends = { low: [33, 102, 172], middle: [247, 247, 247], high: [178, 24, 43] };
  function falseColor(t) {
    const end = t < 0 ? ends.low : ends.high, s = Math.min(1, Math.abs(t));
    return ends.middle.map((v, c) => v + (end[c] - v) * s);
  }
  const scaleValue = () => 10 ** (state.scale / 3);
  function difference(a, b) {
    const out = new ImageData(width, height);
    for (let i = 0; i < width * height; ++i) {
      out.data.set(falseColor((luminance(a.rgb, i) - luminance(b.rgb, i)) / scaleValue()), 4 * i);
      out.data[4 * i + 3] = 255;
    }
    return out;
  }

  // The scale at which all but the largest fiftieth of the differences fits, until somebody chooses one.
  function fitScale(a, b) {
    if (state.scaleIsChosen) return;
    const gaps = Float32Array.from({ length: width * height },
      (_, i) => Math.abs(luminance(a.rgb, i) - luminance(b.rgb, i))).sort();
    const large = gaps[Math.floor(0.98 * gaps.length)];
    state.scale = $('scale').value = Math.min(0, Math.max(-9, Math.ceil(2 * 3 * Math.log10(large || 1)) / 2));
  }

  const view = $('view'), context = view.getContext('2d');
  const scratch = document.createElement('canvas');
  scratch.width = width, scratch.height = height;
  function stamp(image, x, clip) {
    scratch.getContext('2d').putImageData(image, 0, 0);
    const z = state.zoom;
    context.save();
    if (clip) context.beginPath(), context.rect(...clip), context.clip();
    context.imageSmoothingEnabled = false;
    context.drawImage(scratch, x, 0, width * z, height * z);
    context.restore();
  }
  function tag(text, x, align) {
    context.font = '14px "DejaVu Sans", Verdana, sans-serif';
    const w = context.measureText(text).width + 12, left = align === 'right' ? x - w - 6 : x + 6;
    context.fillStyle = 'rgba(0,0,0,.65)';
    context.fillRect(left, 6, w, 22);
    context.fillStyle = '#fff';
    context.fillText(text, left + 6, 22);
  }
  const kGap = 8;  // between two images side by side
  const painters = {
    wipe(a, b, w, h) {
      const x = Math.round(state.wipe * w);
      stamp(shown(a), 0, [0, 0, x, h]);
      stamp(shown(b), 0, [x, 0, w - x, h]);
      context.fillStyle = '#fff';
      context.fillRect(x - 1, 0, 2, h);
      tag('A', 0, 'left'), tag('B', w, 'right');
    },
    flip(a, b) {
      stamp(shown(state.showB ? b : a), 0);
      tag(state.showB ? 'B' : 'A', 0, 'left');
    },
    side(a, b, w) {
      stamp(shown(a), 0);
      stamp(shown(b), w + kGap);
      tag('A', 0, 'left'), tag('B', w + kGap, 'left');
    },
    difference(a, b) { fitScale(a, b), stamp(difference(a, b), 0); },
  };
  // The largest zoom at which nothing has to be scrolled, until somebody chooses one.
  function fitZoom() {
    if (state.zoomIsChosen) return;
    const room = $('stage').clientWidth - 16, shown = state.mode === 'side' ? 2 : 1;
    const across = Math.floor((room - (shown - 1) * kGap) / (shown * width)), down = Math.floor(768 / height);
    state.zoom = $('zoom').value = Math.max(1, Math.min(8, across, down));
  }
  function paint() {
    const w = width * state.zoom, h = height * state.zoom;
    view.width = state.mode === 'side' ? 2 * w + kGap : w, view.height = h;
    painters[state.mode](images[state.a], images[state.b], w, h);
    $('difference-legend').classList.toggle('shown', state.mode === 'difference');
    $('exposure-value').textContent = (state.exposure > 0 ? '+' : '') + state.exposure + ' stops';
    $('zoom-value').textContent = state.zoom + '×';
    const s = scaleValue().toPrecision(2);
    $('scale-low').textContent = '−' + s, $('scale-high').textContent = '+' + s;
  }

  const bar = $('scale-bar'), barContext = bar.getContext('2d');
  for (let x = 0; x < bar.width; ++x) {
    barContext.fillStyle = `rgb(${falseColor(2 * x / (bar.width - 1) - 1).map(Math.round)})`;
    barContext.fillRect(x, 0, 1, bar.height);
  }

  for (const id of ['a', 'b']) {
    images.forEach((p, i) => $(id).add(new Option(p.name, i)));
    $(id).value = state[id];
    $(id).onchange = e => { state[id] = +e.target.value; paint(); };
  }
  for (const id of ['exposure', 'zoom', 'scale']) {
    $(id).value = state[id];
    $(id).oninput = e => {
      state[id] = +e.target.value;
      state[id + 'IsChosen'] = true;
      paint();
    };
  }
  const buttons = [...document.querySelectorAll('[data-mode]')];
  function choose(mode) {
    state.mode = mode;
    for (const button of buttons) button.setAttribute('aria-pressed', button.dataset.mode === mode);
    fitZoom();
    paint();
  }
  for (const button of buttons) button.onclick = () => choose(button.dataset.mode);

  const numbers = (p, i) => [0, 1, 2].map(c => p.rgb[3 * i + c].toFixed(4)).join('  ');
  function read(x, y) {
    if (x < 0 || y < 0 || x >= width || y >= height) return;
    const a = images[state.a], b = images[state.b], i = y * width + x;
    const gap = luminance(a.rgb, i) - luminance(b.rgb, i);
    $('readout').textContent = `Pixel ${x}, ${y}: luminance A minus B ${gap.toFixed(4)}\n` +
      `A  ${numbers(a, i)}    ${a.name}\nB  ${numbers(b, i)}    ${b.name}`;
  }
  view.onpointermove = e => {
    const box = view.getBoundingClientRect(), x = e.clientX - box.left;
    if (state.mode === 'wipe') state.wipe = Math.min(1, Math.max(0, x / box.width)), paint();
    const column = Math.floor(x / state.zoom), gap = width + kGap / state.zoom;
    read(state.mode === 'side' && column >= width ? Math.floor(x / state.zoom - gap) : column,
      Math.floor((e.clientY - box.top) / state.zoom));
  };
  function flip() {
    if (state.mode === 'flip') state.showB = !state.showB, paint();
  }
  view.onclick = flip;
  view.onkeydown = e => { if (e.key === ' ') e.preventDefault(), flip(); };

  // A link may open the report in a certain way: #mode=difference&a=0&b=3&zoom=2
  for (const [key, value] of new URLSearchParams(location.hash.slice(1))) {
    if (key === 'mode' && value in painters) state.mode = value;
    if (['a', 'b'].includes(key) && +value in images) state[key] = +value, $(key).value = value;
    if (['zoom', 'exposure', 'scale'].includes(key) && Number.isFinite(+value))
      state[key] = +value, state[key + 'IsChosen'] = true, $(key).value = value;
  }
  choose(state.mode);
  read(width >> 1, height >> 1);
  document.body.dataset.ready = images.length;
})();

// tracer.js FOLDER KIND SAMPLES WAY SCENE.pbrt...: a path tracer in another style, for make diagnose-trial. It is recursive,
// has its own random numbers, and shares no code with this project. It renders each scene twice into the folder, as pfm or
// png. WAY: "bsdf", "nee" (light sampling) or "mis".
const fs = require('fs'), zlib = require('zlib'), [, , folder, kind, samples, way, ...files] = process.argv;
let state = 77, shapes, lights, sky, maxDepth;
function rnd() {  // mulberry32
    let t = state = state + 0x6D2B79F5 | 0;
    t = Math.imul(t ^ t >>> 15, t | 1), t ^= t + Math.imul(t ^ t >>> 7, t | 61);
    return ((t ^ t >>> 14) >>> 0) / 4294967296;
}
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]], mul = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]], dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const tint = (a, b) => [a[0] * b[0], a[1] * b[1], a[2] * b[2]], unit = a => mul(a, 1 / Math.sqrt(dot(a, a))), EPS = 1e-6;
const BLACK = [0, 0, 0];
const numbers = (key, line) => (m => m && m[1].trim().split(/\s+/).map(Number))(line.match(key + '[\\s\\[]+([-+.e\\d\\s]+)'));
const one = (key, line) => (numbers(key, line) || [undefined])[0];
function nearest(o, d, max) {
    let best = null, t;
    for (const s of shapes) {
        if (s.P) {
            t = dot(sub(s.o, o), s.n) / dot(d, s.n);
            const p = add(sub(o, s.o), mul(d, t)), a = dot(p, s.u) / dot(s.u, s.u), b = dot(p, s.v) / dot(s.v, s.v);
            if (!(t > EPS && t < max && a >= 0 && a <= 1 && b >= 0 && b <= 1)) continue;
        } else {
            const q = sub(o, s.c), b = dot(q, d), h = b * b - dot(q, q) + s.r * s.r;
            if (h < 0) continue;
            t = -b - Math.sqrt(h);
            if (t <= EPS) t = -b + Math.sqrt(h);
            if (!(t > EPS && t < max)) continue;
        }
        best = s, max = t;
    }
    return best && {s: best, t: max, p: add(o, mul(d, max))};
}
const normal = (s, p) => s.P ? s.n : mul(sub(p, s.c), s.side / s.r);
const emitted = (s, n, d) => s.both || dot(n, d) < 0 ? s.L : BLACK;
function aim(z, r, h) {  // the direction at height h and distance r around the axis z
    const x = unit(cross(Math.abs(z[0]) > 0.5 ? [0, 1, 0] : [1, 0, 0], z)), phi = 2 * Math.PI * rnd();
    return add(add(mul(x, r * Math.cos(phi)), mul(cross(z, x), r * Math.sin(phi))), mul(z, h));
}
function cosineDirection(n) { const u = rnd(); return aim(n, Math.sqrt(u), Math.sqrt(1 - u)); }
// The density with which direct() finds the point y of a light (or the sky) in the direction d from o.
const lightDensity = (y, n, o, d) => (y ? y.t * y.t / (y.s.area * Math.abs(dot(normal(y.s, y.p), d))) : dot(n, d) / Math.PI) / lights.length;
function direct(x, n) {
    if (!lights.length) return BLACK;
    const s = lights[Math.floor(rnd() * lights.length)];
    let wi, distance = Infinity, Le = s.L, density;
    if (s.sky) wi = cosineDirection(n), density = dot(wi, n) / Math.PI / lights.length;
    else {
        const h = 1 - 2 * rnd(), y = s.P ? add(s.o, add(mul(s.u, rnd()), mul(s.v, rnd()))) : add(s.c, mul(aim([0, 0, 1], Math.sqrt(1 - h * h), h), s.r));
        const w = sub(y, x.p);
        distance = Math.sqrt(dot(w, w)), wi = mul(w, 1 / distance), Le = emitted(s, normal(s, y), wi);
        density = distance * distance / (s.area * Math.abs(dot(normal(s, y), wi))) / lights.length;
    }
    const cosine = dot(wi, n);
    if (cosine <= 0 || Le === BLACK || nearest(x.p, wi, distance * (1 - 1e-6))) return BLACK;
    const weight = way === 'mis' ? density / (density + cosine / Math.PI) : 1;
    return mul(tint(x.s.color, Le), weight * cosine / Math.PI / density);
}
function radiance(o, d, depth, from, density) {  // from, density: of a diffuse bounce before; else null
    const x = nearest(o, d, Infinity), n = x && normal(x.s, x.p);
    let weight = 1, L = x ? emitted(x.s, n, d) : sky.L;
    if (from && way === 'nee') weight = 0;
    if (from && way === 'mis' && L !== BLACK) weight = density / (density + lightDensity(x, from, o, d));
    L = mul(L, weight);
    if (!x || depth === 0) return L;
    const m = dot(n, d) < 0 ? n : mul(n, -1), cos = -dot(d, m);
    if (x.s.ior) {
        const eta = m === n ? x.s.ior : 1 / x.s.ior, k = 1 - (1 - cos * cos) / (eta * eta), cosT = Math.sqrt(k);
        const rs = (cos - eta * cosT) / (cos + eta * cosT), rp = (eta * cos - cosT) / (eta * cos + cosT), R = k <= 0 ? 1 : (rs * rs + rp * rp) / 2;
        if (rnd() < R) return radiance(x.p, add(d, mul(m, 2 * cos)), depth - 1, null);
        return mul(radiance(x.p, unit(add(mul(d, 1 / eta), mul(m, cos / eta - cosT))), depth - 1, null), 1 / (eta * eta));
    }
    if (x.s.mirror) return add(L, tint(x.s.color, radiance(x.p, add(d, mul(m, 2 * cos)), depth - 1, null)));
    if (x.s.color === BLACK || x.s.color[0] + x.s.color[1] + x.s.color[2] === 0) return L;
    if (way !== 'bsdf') L = add(L, direct(x, m));
    const survive = depth < maxDepth - 1 ? 0.8 : 1;
    if (rnd() >= survive) return L;
    const wi = cosineDirection(m);
    return add(L, tint(mul(x.s.color, 1 / survive), radiance(x.p, wi, depth - 1, m, dot(wi, m) / Math.PI)));
}
const code = v => Math.max(0, Math.min(255, Math.round(255 * (v < 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055))));
const number = v => Buffer.from([v >>> 24, v >>> 16 & 255, v >>> 8 & 255, v & 255]);
const crc = b => ~b.reduce((c, v) => { c ^= v; for (let k = 0; k < 8; k++) c = c & 1 ? c >>> 1 ^ 0xEDB88320 : c >>> 1; return c; }, -1) >>> 0;
const chunk = (kind, data) => (b => Buffer.concat([number(data.length), b, number(crc(b))]))(Buffer.concat([Buffer.from(kind), data]));

// The file has one object on each line.
function render(file, out) {
    const text = fs.readFileSync(file, 'utf8');
    shapes = [];
    for (const line of text.split('\n').filter(l => l.includes('Shape'))) {
        const s = {L: numbers('rgb L"', line) || BLACK, both: /twosided" true/.test(line), ior: /dielectric/.test(line) && 1.5,
                   mirror: /conductor/.test(line), color: numbers('reflectance"', line) || BLACK, P: numbers('P"', line)};
        if (s.P) s.o = s.P.slice(0, 3), s.u = sub(s.P.slice(3, 6), s.o), s.v = sub(s.P.slice(9), s.o), s.n = cross(s.u, s.v);
        if (s.P) s.area = Math.sqrt(dot(s.n, s.n)), s.n = unit(s.n);
        else s.c = numbers('Translate', line), s.r = one('radius"', line), s.area = 4 * Math.PI * s.r * s.r, s.side = /Reverse/.test(line) ? -1 : 1;
        shapes.push(s);
    }
    sky = {L: numbers('rgb L"', text.split('\n').find(l => l.includes('infinite')) || '') || BLACK, sky: true};
    lights = shapes.filter(s => s.L[0] + s.L[1] + s.L[2] > 0).concat(sky.L[0] > 0 ? [sky] : []);
    maxDepth = one('maxdepth"', text);
    const width = one('xresolution"', text), height = one('yresolution"', text);
    const [eye, to, up] = (a => [a.slice(0, 3), a.slice(3, 6), a.slice(6)])(numbers('LookAt', text));
    const ahead = unit(sub(to, eye)), right = unit(cross(up, ahead)), top = cross(ahead, right), half = Math.tan(one('fov"', text) * Math.PI / 360);
    const short = Math.min(width, height), picture = [];
    for (let y = 0; y < height; y++)
        for (let x = 0; x < width; x++) {
            let sum = BLACK;
            for (let i = 0; i < samples; i++) {
                const a = (2 * (x + rnd()) - width) / short * half, b = (height - 2 * (y + rnd())) / short * half;
                const c = radiance(eye, unit(add(ahead, add(mul(right, a), mul(top, b)))), maxDepth, null);
                sum = add(sum, c);
            }
            for (const c of [0, 1, 2]) picture[((height - 1 - y) * width + x) * 3 + c] = sum[c] / samples;
        }
    const rows = [...Array(height).keys()].map(y => Buffer.from([0, ...picture.slice((height - 1 - y) * width * 3, (height - y) * width * 3).map(code)]));
    fs.writeFileSync(out, Buffer.concat(out.endsWith('.png')
        ? [Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'), chunk('IHDR', Buffer.concat([number(width), number(height), Buffer.from([8, 2, 0, 0, 0])])),
           chunk('IDAT', zlib.deflateSync(Buffer.concat(rows))), chunk('IEND', Buffer.alloc(0))]
        : [Buffer.from(`PF\n${width} ${height}\n-1.0\n`), Buffer.from(new Float32Array(picture).buffer)]));
}
for (const file of files) {
    const name = folder + '/' + file.replace(/^.*\/|\.pbrt$/g, '');
    render(file, `${name}.${kind}`), render(file, `${name}.2.${kind}`);
}

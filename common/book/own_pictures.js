// Two pictures of the reader's own, beside each other, with the verdict of the compiled `compare`.

/// A .ppm with 8 bits (P6): {width, height, pixels}, linear.
function readPpm(bytes) {
    const head = new TextDecoder('latin1').decode(bytes.subarray(0, 1 << 16));
    const [all, width, height] = head.match(/^P6\s(?:\s*#.*\n)*\s*(\d+)\s+(?:\s*#.*\n)*(\d+)\s+(?:\s*#.*\n)*255\s/) || [];
    if (!all || bytes.length < all.length + 3 * width * height) throw new Error('not a .ppm with 8 bits for each colour');
    const pixels = new Float32Array(4 * width * height).fill(1);
    for (let i = 0; i < width * height; i++)
        for (let k = 0; k < 3; k++) pixels[4 * i + k] = fromSrgb[bytes[all.length + 3 * i + k]];
    return {width: +width, height: +height, pixels};
}
/// A .png, decoded by the browser without a change of its colours.
async function readPng(bytes) {
    const bitmap = await createImageBitmap(new Blob([bytes], {type: 'image/png'}), {colorSpaceConversion: 'none'});
    const {width, height} = bitmap, canvas = make('canvas', {width, height}), paint = canvas.getContext('2d');
    paint.drawImage(bitmap, 0, 0);
    const data = paint.getImageData(0, 0, width, height).data;
    return {width, height, pixels: Float32Array.from(data, (code, i) => i % 4 === 3 ? 1 : fromSrgb[code])};
}
async function readPicture(name, bytes) {
    const kind = name.toLowerCase().split('.').pop();
    if (kind === 'png') return readPng(bytes);
    if (kind === 'ppm') return readPpm(bytes);
    if (bytes[0] !== 80 || bytes[1] !== 70) throw new Error('not a .pfm with three colours');  // "PF"
    return readPfm(bytes);
}

const own = {names: [], bytes: []};
const viewer = new Viewer(), said = make('pre', {class: 'printed', tabindex: 0, hidden: true});
const problem = make('p', {class: 'errors', role: 'alert'});
const inputs = ['A', 'B, the reference'].map((label, k) => make('input', {
    type: 'file', accept: '.pfm,.ppm,.png', name: 'AB'[k], onchange: event => take(k, event.target.files)
}));
const zone = make('div', {class: 'drop'}, ...inputs.map((input, k) =>
    make('label', {class: 'choose'}, `Picture ${['A', 'B, the reference'][k]}: `, input)), 'or drop both files here');
zone.ondragover = event => event.preventDefault();
zone.ondrop = event => {
    event.preventDefault();
    take(event.dataTransfer.files.length > 1 || !own.bytes[0] ? 0 : 1, event.dataTransfer.files);
};
document.querySelector('.own').replaceChildren(zone, problem, viewer.node, said);

async function take(first, files) {
    for (const [k, file] of [...files].slice(0, 2 - first).entries()) {
        own.names[first + k] = file.name;
        own.bytes[first + k] = new Uint8Array(await file.arrayBuffer());
    }
    if (own.bytes[0] && own.bytes[1]) await compare();
}
async function compare() {
    problem.textContent = '', viewer.node.hidden = true, said.hidden = true;
    const paths = own.names.map((name, k) => `${'AB'[k]}.${name.toLowerCase().split('.').pop()}`);
    const pictures = [];
    for (const [k, name] of own.names.entries()) {
        try {
            pictures.push({...await readPicture(name, own.bytes[k]), name: `${'AB'[k]} ${name}`});
        } catch (error) {
            problem.textContent = `error: ${name}: ${error.message}`;
            return;
        }
    }
    const files = {[`in/${paths[0]}`]: own.bytes[0], [`in/${paths[1]}`]: own.bytes[1]};
    const run = new Run(await engine, 'compare', paths.map(path => `in/${path}`), files, () => {});
    const {code, out, errors} = await run.done;
    problem.textContent = errors.join('\n');
    if (code !== 0) return;
    said.hidden = false, said.textContent = out.join('\n');
    viewer.set(pictures);
}

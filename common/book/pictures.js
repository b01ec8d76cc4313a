// All pages: links to sections, copies of listings; and pictures to look at closely: two beside each other behind a slider, the
// values of a pixel, exposure and the error.

const make = (tag, attributes = {}, ...children) => {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (typeof value === 'function') node[name] = value;
        else if (value !== false) node.setAttribute(name, value === true ? '' : value);
    }
    node.append(...children);
    return node;
};
const digits = x => Number.isFinite(x) ? x.toPrecision(3) : 'not finite';

// 8-bit sRGB to linear radiance, and back for many values between 0 and 1.
const fromSrgb = Float32Array.from({length: 256}, (_, code) => {
    const s = code / 255;
    return s <= 0.04045 ? s / 12.92 : ((s + 0.055) / 1.055) ** 2.4;
});
const steps = 4095;
const toSrgb = Uint8ClampedArray.from({length: steps + 1}, (_, i) => {
    const x = i / steps;
    return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
});

/// The picture in the bytes of a .pfm file: {name, width, height, pixels}, linear, four numbers a pixel from the top left.
function readPfm(bytes, name) {
    const [head, width, height] = new TextDecoder('latin1').decode(bytes.subarray(0, 1 << 16))
        .match(/^PF\s(?:#.*\n)*(\d+)\s+(\d+)\s+(?:#.*\n)*\S+\s/);
    const values = new Float32Array(bytes.slice(head.length).buffer), pixels = new Float32Array(4 * width * height).fill(1);
    for (let i = 0; i < width * height; i++) {
        const from = 3 * (i % width + width * (height - 1 - Math.floor(i / width)));
        pixels.set(values.subarray(from, from + 3), 4 * i);
    }
    return {name, width: +width, height: +height, pixels};
}

/// A canvas with what is needed to look closely. pictures: {name, width, height, pixels}, all of one size. The first
/// is to the left of the slider, the second to the right.
class Viewer {
    constructor() {
        this.left = 0, this.right = 1, this.exposure = 0, this.error = false, this.pictures = [];
        this.canvas = make('canvas', {tabindex: 0, role: 'img', width: 256, height: 256});
        this.overlay = make('div', {class: 'overlay'});
        this.mark = make('div', {class: 'mark', hidden: true});  // around the pixel that keys have chosen
        this.pick = null;  // called with the pixel that is clicked, or chosen by keys and Enter
        this.choices = make('span', {class: 'choices', role: 'group', 'aria-label': 'picture'});
        this.readout = make('output', {class: 'readout'},
            'point at a pixel, or tap it, to read its values, or move by the arrow keys');
        this.range = make('input', {
            type: 'range', min: 0, max: 1, step: 0.005, value: 0.5, oninput: () => this.draw(),
            'aria-label': 'slider between two pictures'
        });
        const button = (name, act) => make('button', {type: 'button', onclick: () => { act(); this.draw(); }}, name);
        this.errorButton = button('error view', () => { this.error = !this.error; });
        this.node = make('div', {class: 'viewer', hidden: true},
            make('div', {class: 'sheet'}, this.canvas, this.overlay, this.mark), this.range, this.choices,
            make('span', {class: 'buttons'}, button('darker', () => { this.exposure -= 0.5; }),
                button('brighter', () => { this.exposure += 0.5; }), this.errorButton), this.readout);
        this.canvas.onpointermove = this.canvas.onpointerdown = event => this.read(this.pixelAt(event));
        this.canvas.onclick = event => this.pick?.(this.pixelAt(event));
        this.canvas.onkeydown = event => this.press(event);
        this.canvas.onblur = () => { this.mark.hidden = true; };
    }

    set(pictures) {
        this.node.hidden = false, this.range.hidden = pictures.length < 2;
        const names = pictures.map(({name}) => name).join('|');
        if (names !== this.names) this.offer(pictures);
        this.names = names;
        this.pictures = pictures;
        const {width, height} = pictures[0];
        if (this.canvas.width !== width || this.canvas.height !== height) {
            this.canvas.width = width, this.canvas.height = height;
        }
        this.draw();
    }
    /// Buttons for the pictures. One that is chosen comes to the right of the slider; what was there, to its left.
    offer(pictures) {
        this.left = 0, this.right = Math.min(1, pictures.length - 1);
        this.choices.replaceChildren(...pictures.length < 2 ? [] : pictures.map(({name}, i) => make('button', {
            type: 'button', onclick: () => {
                if (i !== this.right) this.left = this.right, this.right = i;
                this.draw();
            }
        }, name)));
    }

    /// Moves the mark by one pixel, with Shift by ten, and reads the pixel that it is around.
    press(event) {
        if (event.key === 'Enter' && this.at) return this.pick?.(this.at);
        const way = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
        if (!way) return;
        event.preventDefault();
        const size = [this.canvas.width, this.canvas.height], from = this.at || size.map(n => n >> 1);
        this.at = from.map((v, k) => Math.min(size[k] - 1, Math.max(0, v + way[k] * (event.shiftKey ? 10 : 1))));
        this.mark.hidden = false;
        this.mark.style.left = `${100 * (this.at[0] + 0.5) / size[0]}%`;
        this.mark.style.top = `${100 * (this.at[1] + 0.5) / size[1]}%`;
        this.read(this.at);
    }

    draw() {
        if (this.pictures.length === 0) return;
        const {width, height} = this.pictures[0], image = new ImageData(width, height);
        const a = this.pictures[this.left], b = this.pictures[this.right], gain = steps * 2 ** this.exposure;
        const edge = a === b ? width : Math.round(this.range.value * width);
        for (let i = 0; i < image.data.length; i += 4) {
            const from = i / 4 % width < edge ? a : b;
            for (let k = 0; k < 3; k++) {
                const value = this.error ? this.errorAt(a, b, i) : from.pixels[i + k];
                image.data[i + k] = toSrgb[Math.min(steps, Math.max(0, gain * value | 0))];
            }
            image.data[i + 3] = 255;
        }
        const paint = this.canvas.getContext('2d');
        paint.putImageData(image, 0, 0);
        if (!this.error && edge > 0 && edge < width) {
            paint.fillStyle = '#f80';
            paint.fillRect(edge, 0, Math.max(1, width / 256), height);
        }
        this.canvas.setAttribute('aria-label', this.error ? `how far ${a.name} is from ${b.name}` :
            a === b ? a.name : `${a.name} to the left, ${b.name} to the right`);
        [...this.choices.children].forEach((button, i) => {
            button.setAttribute('aria-pressed', i === this.left || i === this.right);
        });
        this.errorButton.setAttribute('aria-pressed', this.error);
        this.range.disabled = this.error;
    }
    /// |a - b| / (b + 0.1) of the pixel, in grey.
    errorAt(a, b, i) {
        let difference = 0, size = 0;
        for (let k = 0; k < 3; k++) {
            difference += Math.abs(a.pixels[i + k] - b.pixels[i + k]), size += b.pixels[i + k];
        }
        return difference / (size + 0.1);
    }

    pixelAt(event) {
        const box = this.canvas.getBoundingClientRect(), {width, height} = this.canvas;
        const x = Math.floor((event.clientX - box.left) / box.width * width);
        const y = Math.floor((event.clientY - box.top) / box.height * height);
        return [Math.min(width - 1, Math.max(0, x)), Math.min(height - 1, Math.max(0, y))];
    }
    read([x, y]) {
        const i = 4 * (y * this.canvas.width + x), shown = new Set([this.left, this.right]);
        const said = ({name, pixels}) => `${name} (${[...pixels.subarray(i, i + 3)].map(digits).join(', ')})`;
        this.readout.textContent = `pixel ${x},${y}: ${[...shown].map(k => said(this.pictures[k])).join('; ')}`;
    }
}

/// The pictures in an <img>: of a strip each tile, 256 pixels and a border of 2, below a label.
function picturesOf(img) {
    const side = 256, step = side + 4, label = 24, size = {width: img.naturalWidth, height: img.naturalHeight};
    const paint = make('canvas', size).getContext('2d'), tiles = size.width / step;
    paint.drawImage(img, 0, 0);
    const part = (name, x, y, width, height) => ({name, width, height, pixels: Float32Array.from(
        paint.getImageData(x, y, width, height).data, (code, i) => i % 4 === 3 ? 1 : fromSrgb[code])});
    if (size.height !== side + label || !Number.isInteger(tiles)) return [part(img.alt, 0, 0, size.width, size.height)];
    const names = (img.dataset.names || '').split('|');
    return Array.from({length: tiles}, (_, t) => part(names[t] || `tile ${t + 1}`, t * step + 2, label, side, side));
}

/// Opens the pictures of an <img>.
function hold(img) {
    const viewer = new Viewer(), close = make('button', {type: 'button', class: 'close'}, 'close');
    const dialog = make('dialog', {'aria-label': 'pictures'}, close, viewer.node,
        make('p', {class: 'status'}, 'Choose two pictures; the slider is the border between them.'));
    close.onclick = () => dialog.close();
    dialog.onclose = () => dialog.remove();
    document.body.append(dialog);
    viewer.set(picturesOf(img));
    dialog.showModal();
}

for (const img of document.querySelectorAll('main img[src^="data:image/png"]:not(.thumbnail)')) {
    img.onclick = () => hold(img);
    img.after(make('button', {type: 'button', class: 'hold', onclick: img.onclick},
        'look closely: values, error, two pictures in one'));
}

// Each section can be linked to, and each listing copied.
for (const heading of document.querySelectorAll('main :is(h2, h3, h4)[id]')) {
    heading.append(' ', make('a', {class: 'anchor', href: `#${heading.id}`, 'aria-label': 'link to this section'}, '#'));
}
for (const code of document.querySelectorAll('main div.sourceCode')) {
    const copy = () => navigator.clipboard.writeText(code.querySelector('code').textContent);
    code.append(make('button', {class: 'copy', onclick: copy}, 'copy'));
}

// Of the sidebar the part of this page is open; on a phone the sidebar begins closed.
document.querySelector('.sidebar details:has([aria-current])')?.setAttribute('open', '');
if (matchMedia('(max-width: 60rem)').matches) document.querySelector('.sidebar').open = false;

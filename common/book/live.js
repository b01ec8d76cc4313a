// The live part of a chapter's page: its program, run in this page.

/// A number or a choice of the form, as its label and field.
function field(name, label, attributes, values) {
    const input = values ?
        make('select', {name, ...attributes}, ...values.map(value => make('option', {}, value))) :
        make('input', {name, ...attributes});
    return make('label', {}, `${label} `, input);
}
const count = (name, label, value, min = 1) => field(name, label, {type: 'number', min: Math.min(min, value), value});

class Live {
    constructor(name, data) {
        this.name = name, this.data = data, this.about = chapters[name], this.runs = [];
        this.viewer = new Viewer();
        this.status = make('p', {class: 'status', role: 'status'},
            'The pictures of this page, until you render one here.');
        this.errors = make('ul', {class: 'errors', role: 'alert'});
        this.text = make('pre', {class: 'printed', tabindex: 0, hidden: true});
        const [first, more] = this.fields();
        this.stopping = make('button',
            {type: 'button', class: 'stop', disabled: true, onclick: () => this.stop()}, 'Stop');
        this.form = make('form', {class: 'options'}, ...first,
            make('button', {type: 'submit', class: 'go'}, 'Render'),
            this.stopping,
            make('details', {class: 'more'}, make('summary', {}, 'more'), ...more));
        this.form.onsubmit = event => { event.preventDefault(); this.render(); };
        this.node = document.getElementById('live');
        this.node.append(this.form, this.errors, this.viewer.node, this.status, this.text);
        if (this.about.kind === 'film') {
            this.node.append(layers(this), race(this));
            this.viewer.pick = ([x, y]) => this.tell(x, y);
        }
        if (this.about.scene) this.node.insertBefore(this.editor(), this.errors);
    }

    fields() {
        const about = this.about, own = (about.own || []).map(o => o.values ?
            field(o.name, `--${o.name}`, {}, o.values) : count(o.name, `--${o.name}`, o.value));
        const seed = count('seed', 'Another seed gives other random numbers:', 0);
        if (about.n) return [[count('n', 'samples', about.n)], [seed]];
        const names = Object.keys(this.data.files).filter(file => file.endsWith('.pbrt')).map(file => file.slice(7, -5));
        const scene = field('scene', 'scene', {}, names);
        scene.lastChild.value = about.scene;
        const sizes = ['256x256', '24x24', '64x64', '128x128', '512x512'];
        const size = field('size', 'The picture has so many pixels:', {}, sizes);
        if (about.kind === 'once') return [[scene], [...own, size]];
        return [[scene, count('spp', 'samples per pixel', about.spp)], [...own, size, seed,
            field('sampler', 'The random numbers of a pixel are', {}, ['independent', 'stratified', 'sobol']),
            field('max-depth', 'Paths scatter at most so many times:',
                {type: 'number', min: 0, placeholder: 'of the scene'}),
            field('paths', 'Only these classes of paths count:', {placeholder: 'all; LD(S|D)*E', size: 12})]];
    }

    /// The scene's text, which may be changed.
    editor() {
        this.editing = make('textarea', {spellcheck: 'false', rows: 14, 'aria-label': 'text of the scene'});
        const fill = () => { this.editing.value = textOf(this.data.files[this.sceneName()]); };
        this.form.elements.scene.onchange = fill;
        fill();
        return make('details', {}, make('summary', {}, 'The scene, to be changed'), this.editing);
    }

    /// The options in the form, as words.
    options() {
        const words = [];
        for (const {name, value} of this.form.elements) {
            if (!name || name === 'scene' || name === 'n' || value === '') continue;
            const isDefault = (this.about.own || []).some(o => o.name === name && o.values?.[0] === value);
            if (!isDefault) words.push(`--${name}`, value);
        }
        return words;
    }
    /// Starts a program, which stop() ends.
    run(program, args, files, show = () => {}) {
        const run = new Run(this.data, program, args, files, show);
        this.runs.push(run);
        return run.done;
    }
    /// A program of a chapter, with the scene as it stands in the page.
    start(program, args, show) {
        if (!this.about.scene) return this.run(program, args, {});
        const files = {...this.data.files, [this.sceneName()]: this.editing.value};
        return this.run(program, [...args, '--threads', '1'], files, show);
    }
    stop() {
        for (const run of this.runs) run.stop();
        this.runs = [];
    }

    async render() {
        this.stop();
        this.errors.replaceChildren();
        this.viewer.overlay.replaceChildren();
        this.stopping.disabled = false;
        this.began = performance.now();
        this.status.textContent = 'working';
        const done = await this[this.about.kind]();
        this.stopping.disabled = true;
        if (done.code === null) this.status.textContent += ', stopped';
        else this.report(done);
    }
    /// What the form says, as the words of a command.
    words() {
        const {n} = this.form.elements;
        return n ? ['--n', n.value, ...this.options()] :
            [this.sceneName(), ...this.options(), ...this.about.words || []];
    }
    /// One run that shows all at its end.
    once() { return this.start(this.name, [...this.words(), '--out', 'out/picture.pfm']); }
    sceneName() { return `scenes/${this.form.elements.scene.value}.pbrt`; }

    /// Parts of the samples in several workers, each into a film of its own; then all as one.
    async film() {
        const spp = Math.max(1, +this.form.elements.spp.value);
        const parts = Math.max(1, Math.min(navigator.hardwareConcurrency || 1, spp, 8)), shown = [];
        const results = await Promise.all(Array.from({length: parts}, (_, k) => this.start(this.name, [
            ...this.words(), '--film', `out/${k}.film`, '--film-every', '0.1', '--part',
            `${k + 1}/${parts}`, '--out', 'out/picture.pfm'
        ], message => {
            // Drawn once for all workers, since they are about equally far.
            shown[k] = message;
            if (k === 0) this.progress(shown.filter(Boolean));
        })));
        const failed = results.find(result => result.code !== 0);
        if (failed || parts === 1) return failed || results[0];
        const films = Object.assign({}, ...results.map(({files}, k) => ({[`in/${k}.film`]: files[`out/${k}.film`]})));
        const whole = await this.run('merge', ['out/picture.pfm', ...Object.keys(films)], films);
        return {...whole, out: [...results[0].out.slice(0, 1), ...whole.out]};
    }
    progress(parts) {
        const picture = joined(parts);
        let n = 0;
        for (let i = 3; i < picture.pixels.length; i += 4) n += picture.pixels[i];
        this.viewer.set([{...picture, name: this.name}]);
        this.status.textContent = `${(n / picture.pixels.length * 4).toFixed(1)} samples per pixel, ` +
            `mean ${parts[0].mean.toPrecision(5)} ± ${parts[0].error.toPrecision(2)}, ${this.seconds()} s`;
    }
    seconds() { return ((performance.now() - this.began) / 1000).toFixed(1); }

    report({code, files, out, errors}) {
        this.result = files;
        if (files['out/picture.pfm']) this.viewer.set([readPfm(files['out/picture.pfm'], this.name)]);
        this.print(out);
        this.complain(errors);
        this.status.textContent = code === 0 ? `done in ${this.seconds()} s` : `the program ended with code ${code}`;
    }
    print(out, hint = '') {
        this.text.hidden = out.length === 0;
        this.text.textContent = out.filter(line => !line.startsWith('wrote ')).join('\n') + hint;
    }
    complain(errors) { this.errors.replaceChildren(...errors.map(line => make('li', {}, line))); }

    /// The story of a path through a pixel, drawn into the picture.
    async tell(x, y) {
        if (!this.result) return;
        if (this.told?.x === x && this.told.y === y) this.told.sample++;
        else this.told = {x, y, sample: 0};
        const spp = Math.max(1, +this.form.elements.spp.value), sample = this.told.sample % spp;
        const done = await this.start(this.name,
            [...this.words(), '--explain', `${x},${y},${sample}`, '--out', 'out/path.ppm']);
        this.complain(done.errors);
        if (done.code !== 0) return;
        this.print(done.out, '\n\nClick the same pixel again (or press Enter) to see its next sample.');
        this.lay(textOf(done.files['out/path.svg']));
    }
    /// Lays the drawing of a path over the picture: of its two panels that of the camera, without the
    /// small picture that is in it.
    lay(text) {
        const over = new DOMParser().parseFromString(text, 'image/svg+xml').documentElement.querySelector('svg');
        if (!over) return;
        over.querySelector('image').remove();
        for (const name of ['x', 'y', 'width', 'height']) over.removeAttribute(name);
        this.viewer.overlay.replaceChildren(over);
    }
}

// The live part stands before the second section. Until it has rendered, it shows the pictures of the page.
const waiting = document.querySelector('#live .status'), strip = document.querySelector('main img[data-names]');
document.querySelectorAll('main h2')[1].before(document.getElementById('live'));
engine.then(async data => {
    window.live = new Live(document.body.dataset.chapter, data);
    waiting.remove();
    await strip.decode();
    if (!window.live.began) window.live.viewer.set(picturesOf(strip));
}).catch(error => { waiting.textContent = `No live part in this browser: ${error.message}`; });

// Beside a chapter's live picture: its layers by class of path, and a second method in equal time.

const number3 = x => x.toPrecision(3);
const svg = (tag, attributes = {}, ...children) => {
    const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    node.append(...children);
    return node;
};

/// A button that splits the picture by classes of path, and the list of them.
function layers(live) {
    const list = make('div', {class: 'layers'});
    const split = make('button', {type: 'button'}, 'Split by classes of path');
    split.onclick = async () => {
        list.textContent = 'working';
        const {code, files, errors} = await live.start(live.name, [live.sceneName(), ...live.options(),
            '--out', 'out/picture.pfm', '--split', 'out/classes']);
        list.textContent = '';
        live.complain(errors);
        if (code !== 0) return;
        const whole = {...readPfm(files['out/picture.pfm']), name: 'all'};
        const classes = Object.keys(files).filter(file => file.startsWith('out/classes/') && file.endsWith('.pfm'));
        const found = classes.map(file => ({...readPfm(files[file]), name: file.slice(12, -4)}));
        const share = picture => mean(picture) / mean(whole);
        found.sort((a, b) => share(b) - share(a));
        live.viewer.set([whole, found[0]]);
        const button = picture => make('button', {type: 'button', onclick: () => {
            live.viewer.left = 0, live.viewer.right = 1, live.viewer.slider = 0;
            live.viewer.range.value = 0;
            live.viewer.set([whole, picture]);
        }}, `${picture.name} ${(100 * share(picture)).toFixed(1)} %`);
        const large = found.filter((picture, i) => i < 8 && share(picture) >= 0.01), rest = found.slice(large.length);
        list.append(...[whole, ...large].map(button));
        if (rest.length === 0) return;
        const sum = rest.reduce((all, picture) => all + share(picture), 0);
        list.append(make('details', {class: 'rest'},
            make('summary', {}, `${rest.length} more classes, together ${(100 * sum).toFixed(1)} %`),
            ...rest.map(button)));
    };
    return make('div', {class: 'by-class'}, split, list);
}
function mean(picture) {
    let sum = 0;
    for (let i = 0; i < picture.pixels.length; i++) if (i % 4 !== 3) sum += picture.pixels[i];
    return sum / (picture.pixels.length / 4 * 3);
}

/// Two methods side by side in equal time, and their error as it falls.
function race(live) {
    const names = Object.keys(chapters).filter(name => chapters[name].kind === 'film');
    const other = field('other', 'against', {}, [live.about.against || '15_mis_ris', ...names]);
    const words = field('words', 'with', {placeholder: 'its options', size: 18});
    const time = field('time', 'seconds each', {type: 'number', min: 1, value: 5});
    const chart = svg('svg', {viewBox: '0 0 360 220', class: 'chart', role: 'img', 'aria-label': 'error against time'});
    const viewer = new Viewer(), said = make('p', {class: 'status', role: 'status'});
    const form = make('form', {class: 'options'}, other, words, time, make('button', {type: 'submit'}, 'Race'));
    form.onsubmit = async event => {
        event.preventDefault();
        live.stop();
        const fields = form.elements, about = {live, viewer, chart, said, seconds: +fields.time.value};
        await run_race(about, [
            {name: live.name, words: live.options().filter((_, i, all) => !isSpp(all, i))},
            {name: fields.other.value, words: [...common_words(live), ...fields.words.value.match(/\S+/g) || []]}
        ]);
    };
    return make('details', {class: 'race'}, make('summary', {}, 'Two methods in equal time'), form, viewer.node,
        chart, said);
}
const isSpp = (words, i) => words[i] === '--spp' || words[i - 1] === '--spp';
/// The options that every chapter understands.
function common_words(live) {
    const shared = ['--size', '--sampler', '--seed', '--max-depth', '--paths'], words = live.options();
    return words.filter((_, i) => shared.includes(words[i % 2 ? i - 1 : i]));
}

/// Runs both methods for the same time. If there is a reference of the scene, both render in its size and
/// are compared with it; else the error is the one that each film tells of itself.
async function run_race({live, viewer, chart, said, seconds}, methods) {
    const scene = live.sceneName(), untouched = live.editing.value === live.data.scenes[scene];
    const file = untouched && live.data.references[scene];
    const reference = file && {...readPfm(file), name: 'reference'};
    const shown = [], own = reference && `${reference.width}x${reference.height}`;
    for (const method of methods) method.points = [];
    said.textContent = 'working';
    const sized = words => own ? [...words.filter((word, i) => word !== '--size' && words[i - 1] !== '--size'),
        '--size', own] : words;
    const runs = methods.map((method, k) => live.start(method.name, [scene, ...sized(method.words), '--time', `${seconds}`,
        '--film', 'out/x.film', '--film-every', '0.1', '--out', 'out/picture.pfm', '--stats', 'out/stats.json'
    ], message => {
        shown[k] = {...message, name: method.name};
        const error = reference ? relMse(message, reference) : (message.error / message.mean) ** 2;
        method.measure = reference ? 'relMSE' : '(standard error of the mean / mean)²';
        if (error > 0 && Number.isFinite(error)) method.points.push([message.seconds, error]);
        if (shown[0] && shown[1]) viewer.set([...shown, ...reference ? [reference] : []]);
        draw_chart(chart, methods);
    }));
    const results = await Promise.all(runs);
    live.complain(results.flatMap(result => result.errors));
    if (results.some(result => result.code !== 0)) {
        said.textContent = '';
        return;
    }
    const last = methods.map(method => method.points.at(-1)?.[1]);
    said.textContent = last[0] && last[1] ?
        `${methods[0].measure}: ${methods[0].name} ${number3(last[0])}, ${methods[1].name} ${number3(last[1])}; ` +
        `in equal time the first is ${number3(last[1] / last[0])} times as efficient` +
        (own ? `. Both rendered ${own} pixels, the size of the reference.` : '') : 'too little time';
}

/// Error against time, both logarithmic.
function draw_chart(chart, methods) {
    const points = methods.flatMap(method => method.points);
    if (points.length < 2) return;
    const range = k => {
        const logs = points.map(p => Math.log10(p[k]));
        return [Math.floor(Math.min(...logs) * 2) / 2, Math.ceil(Math.max(...logs) * 2) / 2 + 0.01];
    };
    const [[t0, t1], [e0, e1]] = [range(0), range(1)];
    const x = t => 50 + 300 * (Math.log10(t) - t0) / (t1 - t0), y = e => 185 - 170 * (Math.log10(e) - e0) / (e1 - e0);
    const parts = [svg('rect', {x: 50, y: 15, width: 300, height: 170, class: 'frame'})];
    for (const [low, high, place] of [[t0, t1, 0], [e0, e1, 1]]) {
        for (let decade = Math.ceil(low); decade <= high; decade++) {
            const at = place === 0 ? {x: x(10 ** decade), y: 202, 'text-anchor': 'middle'} :
                {x: 45, y: y(10 ** decade) + 4, 'text-anchor': 'end'};
            const line = place === 0 ? {x1: at.x, x2: at.x, y1: 15, y2: 185} :
                {x1: 50, x2: 350, y1: at.y - 4, y2: at.y - 4};
            parts.push(svg('line', {...line, class: 'grid'}), svg('text', at, `${+(10 ** decade).toPrecision(1)}`));
        }
    }
    parts.push(svg('text', {x: 350, y: 217, 'text-anchor': 'end'}, 'seconds'),
        svg('text', {x: 50, y: 10}, methods[0].measure));
    methods.forEach((method, k) => {
        const line = method.points.map(([t, e]) => `${x(t).toFixed(1)},${y(e).toFixed(1)}`).join(' ');
        parts.push(svg('polyline', {points: line, class: `curve curve${k + 1}`}),
            svg('text', {x: 345, y: 32 + 16 * k, 'text-anchor': 'end', class: `name${k + 1}`},
                `${k + 1}: ${method.name}`));
    });
    chart.replaceChildren(...parts);
}

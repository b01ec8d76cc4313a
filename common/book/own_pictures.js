// Two pictures of the reader's own, beside each other, with the verdict of the compiled `compare`.

const own = [], viewer = new Viewer(), said = make('pre', {class: 'printed', tabindex: 0, hidden: true});
const problem = make('p', {class: 'errors', role: 'alert'});
const inputs = ['A', 'B, the reference'].map((label, k) => make('input', {
    type: 'file', accept: '.pfm,.ppm,.png', 'aria-label': `Picture ${label}`, onchange: event => take(k, event.target.files)
}));
const zone = make('div', {class: 'drop'}, ...inputs.map((input, k) =>
    make('p', {}, `Picture ${['A', 'B, the reference'][k]}: `, input)), 'or drop both files here');
zone.ondragover = event => event.preventDefault();
zone.ondrop = event => {
    event.preventDefault();
    take(event.dataTransfer.files.length > 1 || !own[0] ? 0 : 1, event.dataTransfer.files);
};
document.querySelector('.own').replaceChildren(zone, problem, viewer.node, said);

async function take(first, files) {
    for (const [k, file] of [...files].slice(0, 2 - first).entries()) {
        const bytes = new Uint8Array(await file.arrayBuffer());
        own[first + k] = {bytes, name: file.name, path: `${'AB'[first + k]}/${file.name}`};
    }
    if (own[0] && own[1]) await compare();
}
async function compare() {
    viewer.node.hidden = said.hidden = true;
    const files = Object.fromEntries(own.map(({path, bytes}) => [path, bytes]));
    const {code, out, errors} = await new Run(await engine, 'compare', own.map(({path}) => path), files, () => {}).done;
    problem.textContent = errors.join('\n');
    if (code !== 0) return;
    said.hidden = false, said.textContent = out.join('\n');
    viewer.set(await Promise.all(own.map(async ({bytes, name}) => ({...await readPicture(bytes), name}))));
}

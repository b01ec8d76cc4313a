// The book in a headless browser, from the file system and without a network: that its links lead
// somewhere, that its pictures and its live parts do what they say, and that a chapter makes the same
// bytes in a page as on the command line; then the same in Firefox.
// Usage: node test.js BOOK BUILD CHROMIUM [FIREFOX]
const {execFileSync} = require('child_process'), fs = require('fs'), path = require('path');
const {Browser} = require('./browser.js'), {Firefox} = require('./firefox.js');
const [build, chromium, firefox] = process.argv.slice(3), book = path.resolve(process.argv[2]);

let failed = 0;
function check(claim, holds, detail = '') {
    console.log(`${holds ? 'ok      ' : 'FAILED  '}${claim}${detail && `: ${detail}`}`);
    if (!holds) failed++;
}
const page = chapter => `${book}/chapters/${chapter}/index.html`;

function pages(folder = book) {
    return fs.readdirSync(folder, {withFileTypes: true}).flatMap(entry => {
        const file = path.join(folder, entry.name);
        return entry.isDirectory() ? pages(file) : file.endsWith('.html') ? [file] : [];
    });
}

/// The colours of a part of the window, as it is on the screen: r, g, b, a of one pixel after the other.
async function on_screen(browser, {x, y, width, height}) {
    const file = `${build}/book-test.png`;
    await browser.screenshot(file);
    const png = fs.readFileSync(file).toString('base64');
    fs.rmSync(file);
    return browser.value(`fetch('data:image/png;base64,${png}').then(answer => answer.blob()).then(createImageBitmap)
        .then(picture => { const canvas = document.createElement('canvas');
            canvas.width = ${width}, canvas.height = ${height};
            const paint = canvas.getContext('2d');
            paint.drawImage(picture, ${-x}, ${-y});
            return [...paint.getImageData(0, 0, ${width}, ${height}).data]; })`);
}
const box_of = (browser, selector) => browser.value(`(() => { const node = document.querySelector('${selector}');
    node.scrollIntoView({block: 'center'});
    const {x, y, width, height} = node.getBoundingClientRect();
    return {x: Math.round(x), y: Math.round(y), width: Math.round(width), height: Math.round(height)}; })()`);

/// Every page, wide and narrow: no error, no link to nowhere, no picture without words, nothing too wide or cut off.
async function every_page(browser) {
    const anchors = new Map(), links = [], bad = [];
    for (const width of [1400, 390]) {
        await browser.width(width);
        for (const file of pages()) {
            await browser.open(file);
            const seen = await browser.value(`({
                ids: [...document.querySelectorAll('[id]')].map(e => e.id),
                links: [...document.querySelectorAll('a[href]')].map(a => a.href),
                pictures: [...document.images].filter(i => !i.naturalWidth || !(i.alt || i.matches('.thumbnail'))).length,
                inner: innerWidth,
                wide: document.documentElement.scrollWidth - innerWidth,
                bars: [...document.querySelectorAll('.formula')].filter(f => f.offsetWidth > f.clientWidth).length,
                cut: [...document.querySelectorAll('main table, main pre, .formula')].filter(node =>
                    node.scrollWidth > node.clientWidth + 1 && getComputedStyle(node).overflowX !== 'auto' ||
                    node.getBoundingClientRect().right > innerWidth).length
            })`);
            anchors.set(file, new Set(seen.ids));
            if (width === 1400) links.push(...seen.links.map(link => [file, link]));
            const name = path.relative(book, file);
            if (seen.pictures > 0) bad.push(`${name}: ${seen.pictures} pictures are missing or have no words`);
            if (seen.bars > 0) bad.push(`${name}: ${seen.bars} formulas with a vertical scroll bar`);
            if (seen.cut > 0) bad.push(`${name}: ${seen.cut} tables, listings or formulas are cut off at ${width}`);
            if (seen.inner > width) bad.push(`${name}: ${seen.inner} pixels wide, not ${width}`);
            if (seen.wide > 0) bad.push(`${name}: ${seen.wide} pixels too wide for ${width}`);
        }
    }
    for (const [file, link] of links) {
        if (!link.startsWith('file://')) continue;
        const [target, anchor] = decodeURIComponent(link.slice(7)).split('#');
        const known = anchors.get(target);
        if (!known || (anchor && !known.has(anchor))) bad.push(`${path.relative(book, file)} links to ${link}`);
    }
    check(`${anchors.size} pages, 1400 and 390 pixels wide, and ${links.length} links`, bad.length === 0,
        bad.slice(0, 10).join('; '));
}

/// Clicks on Render: with the form as it is, until something is to be seen; then as `set` leaves it, which
/// makes what the program makes.
async function same_bytes(browser, chapter, set, args) {
    await browser.open(page(chapter));
    await browser.until(`document.querySelector('.go')`);
    const idle = await browser.value(`live.viewer.node.checkVisibility()`);
    const render = async () => {
        const {x, y, width, height} = await box_of(browser, '.go');
        await browser.click(x + width / 2, y + height / 2);
    };
    await render();
    const shown = await browser.until(`(() => { const canvas = live.viewer.canvas, {width, height} = canvas;
        const {data} = canvas.getContext('2d').getImageData(0, 0, width, height);
        return canvas.checkVisibility() && data.filter((v, i) => i % 4 === 1 && v > 16).length > width * height / 100;
    })()`, 60).then(() => true, () => false);
    check(`Render with the defaults shows a picture, and there was none: ${chapter}`, shown && !idle);
    await browser.value(`live.stop()`);
    await browser.until(`document.querySelector('.stop').disabled`);
    await browser.value(`live.fill(${JSON.stringify(set)}); live.status.textContent = ''`);
    await render();
    await browser.until(`live.status.textContent.startsWith('done') && document.querySelector('.stop').disabled`, 60);
    const here = await browser.value(`Array.from(live.result?.['out/picture.pfm'] || [],
        byte => String.fromCharCode(byte)).join('')`);
    const file = `${build}/book-test.pfm`;
    execFileSync(`${build}/${chapter}`, [...args, '--out', file, '--quiet']);
    const native = fs.readFileSync(file).toString('latin1');
    fs.rmSync(file);
    check(`the same bytes as the program: ${chapter}`, here === native);
}
/// Files that the module makes when the page is opened, instead of being packed.
async function same_scenes(browser) {
    await browser.open(page('15_mis_ris'));
    const made = await browser.value(`engine.then(async data => {
        const hash = async name => [...new Uint8Array(await crypto.subtle.digest('SHA-256', data.files[name]))].join(' ');
        return Promise.all(made.split(' ').map(async name => [name, await hash(name)])); })`);
    const native = name => [...require('crypto').createHash('sha256').update(fs.readFileSync(name)).digest()].join(' ');
    check(`the page makes the same ${made.length} scenes and meshes`, made.length === 3 && made.every(([name, hash]) => hash === native(name)),
        made.filter(([name, hash]) => hash !== native(name)).map(([name]) => name).join(', '));
}
async function all_same_bytes(browser, chapters) {
    for (const [chapter, {kind, n}] of Object.entries(chapters)) {
        if (kind === 'table') {
            const some = n > 1024 ? '4096' : '256';
            await same_bytes(browser, chapter, {n: some, seed: 3}, ['--n', some, '--seed', '3']);
            continue;
        }
        const scene = {'16_lens_and_shutter': 'bokeh', '17_sky_image': 'sky', '18_dispersion': 'prism', '19_adaptive': 'high-contrast'}[chapter] || 'cornell-spheres';
        const size = '24x24', words = [`scenes/${scene}.pbrt`, '--size', size];
        if (kind === 'film') words.push('--spp', '18', '--seed', '5');
        if (chapter === '26_radiosity') words.splice(0, 1, 'scenes/cornell.pbrt', '--patches', '200', '--shots', '50');
        const set = {scene: words[0].slice(7, -5), size, spp: 18, seed: 5, patches: 200, shots: 50};
        if (chapter === '23_photon_mapping' || chapter === '24_progressive_photons') set.photons = 2000, words.push('--photons', '2000');
        await same_bytes(browser, chapter, set, words);
    }
}

async function live(browser) {
    await browser.width(1400);
    await browser.open(page('15_mis_ris'));
    await browser.until(`document.querySelector('.go')`);
    await browser.value(`live.fill({scene: 'cornell', spp: 4})`);
    await browser.value(`live.node.scrollIntoView(); document.querySelector('.go').click()`);
    const stays_free = await browser.value(`new Promise(free => { const t = performance.now();
        setTimeout(() => free(performance.now() - t), 20); })`);
    check('the page stays free while it renders', stays_free < 500, `${stays_free.toFixed(0)} ms for a timer of 20`);
    await browser.until(`live.status.textContent.startsWith('done')`, 60);
    const values = await browser.value(`live.viewer.pictures[0].pixels.filter((x, i) => i % 4 === 0 && x > 0).length`);
    check('the picture is there', values > 30000);

    await path_story(browser);
    await path_by_keys(browser);
    await layers_and_viewer(browser);
    await wrong_scene(browser);
    await browser.value(`live.fill({scene: 'thousand-lights', spp: 100000}); document.querySelector('.go').click()`);
    await browser.until(`live.status.textContent.includes('samples per pixel')`);
    await browser.value(`document.querySelector('.stop').click()`);
    await browser.until(`live.status.textContent.endsWith('stopped')`, 5);
    check('stop ends a long render', true);
}
async function path_story(browser) {
    const {x, y} = await browser.value(`(() => { live.viewer.canvas.scrollIntoView({block: 'center'});
        const box = live.viewer.canvas.getBoundingClientRect();
        return {x: box.x + box.width / 2, y: box.y + 0.8 * box.height}; })()`);
    const canvas = await box_of(browser, '.live canvas'), before = await on_screen(browser, canvas);
    await browser.click(x, y);
    await browser.until(`live.viewer.overlay.querySelector('svg circle')`);
    const after = await on_screen(browser, canvas);
    const same = before.filter((v, i) => i % 4 === 1 && Math.abs(v - after[i]) < 8).length / (before.length / 4);
    check('the drawing of a path leaves the picture visible', same > 0.7 && same < 0.999, `${(100 * same).toFixed(0)} % of it`);
    const story = await browser.value('live.text.textContent');
    const [, a, b] = story.match(/pixel (\d+),(\d+) sample 0/) || [];
    check('a click tells the path of its pixel', Math.abs(a - 128) <= 1 && Math.abs(b - 204) <= 1, `pixel ${a},${b}`);
    const off = await browser.value(`(() => { const box = live.viewer.overlay.querySelector('circle[fill="#c03"]')
        .getBoundingClientRect(); return [box.x + box.width / 2 - ${x}, box.y + box.height / 2 - ${y}]; })()`);
    check('its first vertex is drawn there', Math.hypot(...off) <= 4, `${off.map(Math.round)} pixels off`);
}
/// The same by keys alone.
async function path_by_keys(browser) {
    await browser.value(`live.viewer.overlay.replaceChildren(); live.viewer.canvas.focus()`);
    for (const key of ['ArrowDown', 'ArrowDown', 'ArrowRight', 'Enter']) await browser.key(key);
    await browser.until(`live.viewer.overlay.querySelector('svg circle')`);
    const story = await browser.value('live.text.textContent');
    check('arrow keys choose a pixel, and Enter tells its path', story.includes('pixel 129,130 sample 0'), story.slice(0, 60));
}
/// Tab reaches all that a mouse can use, with a frame around it, and Enter renders.
async function by_keyboard(browser) {
    await browser.open(page('15_mis_ris'));
    await browser.until(`document.querySelector('.go')`);
    const [count, mouse_only] = await browser.value(`(() => {
        for (const part of document.querySelectorAll('main details')) part.open = true;
        live.fill({scene: 'cornell', size: '24x24', spp: 1});
        const is_shown = node => node.checkVisibility() && !node.disabled && !node.closest('dialog');
        window.usable = new Set([...document.querySelectorAll('a[href], button, input, select, textarea, summary, [tabindex="0"]')]
            .filter(is_shown));
        window.bare = [];
        // A picture has a button behind it that does the same.
        return [usable.size, [...document.querySelectorAll('*')].filter(node => (node.onclick || node.onpointerdown) &&
            is_shown(node) && !usable.has(node) && !node.nextElementSibling?.matches('.hold')).length];
    })()`);
    for (let presses = 0, ends = false; presses < 2 * count && !ends; presses++) {
        await browser.key('Tab');
        ends = await browser.value(`(() => { const node = document.activeElement;
            if (usable.has(node) && getComputedStyle(node).outlineStyle === 'none') bare.push(node.outerHTML.slice(0, 60));
            usable.delete(node);
            return usable.size === 0; })()`);
    }
    const [left, bare] = await browser.value(`[[...usable].map(node => node.outerHTML.slice(0, 60)), bare]`);
    check(`Tab reaches all ${count} links, buttons and fields`, left.length === 0 && mouse_only === 0, left.slice(0, 3).join(' '));
    check('what it reaches has a frame', bare.length === 0, bare.slice(0, 3).join(' '));
    await browser.open(page('15_mis_ris'));
    await browser.until(`document.querySelector('.go')`);
    await browser.value(`live.fill({scene: 'cornell', size: '24x24', spp: 1}), 0`);
    for (let presses = 0; presses < 2 * count && !await browser.value(`document.activeElement.matches('.go')`); presses++) {
        await browser.key('Tab');
    }
    await browser.key('Enter');
    await browser.until(`live.status.textContent.startsWith('done')`, 60);
    check('Enter on its button renders', true);
}
async function layers_and_viewer(browser) {
    await browser.value(`document.querySelector('.by-class button').click()`);
    await browser.until(`document.querySelectorAll('.layers button').length > 3`, 60);
    const shares = await browser.value(`[...document.querySelectorAll('.layers button')].map(b => b.textContent)`);
    const sum = shares.slice(1).reduce((s, text) => s + parseFloat(text.split(' ')[1]), 0);
    check('the classes of path sum to the picture', Math.abs(sum - 100) < 0.5, shares.slice(0, 5).join(', '));
    const before = await browser.value(`live.viewer.canvas.toDataURL()`);
    await browser.value(`{ const range = live.viewer.range; range.value = 1; range.oninput(); }`);
    check('the slider changes the picture', before !== await browser.value(`live.viewer.canvas.toDataURL()`));
}
async function wrong_scene(browser) {
    await browser.value(`live.fill({scene: 'cornell', spp: 1}); live.editing.value =
        live.editing.value.replace('WorldBegin', 'WorldBegn'); document.querySelector('.go').click()`);
    await browser.until(`document.querySelector('.errors li')`);
    const said = await browser.value(`document.querySelector('.errors').textContent`);
    check('a mistake in the scene is named with its place', /cornell\.pbrt:\d+:\d+: .*WorldBegn/.test(said), said);
}

function size(folder = book) {
    return fs.readdirSync(folder, {withFileTypes: true}).reduce((sum, entry) => sum + (entry.isDirectory()
        ? size(path.join(folder, entry.name)) : fs.statSync(path.join(folder, entry.name)).size), 0);
}

async function races(browser) {
    await browser.open(page('15_mis_ris'));
    await browser.until(`document.querySelector('.go')`);
    await browser.value(`live.fill({scene: 'veach-mis'}); document.querySelector('.race').open = true;
        { const form = document.querySelector('.race form'); form.elements.time.value = 4;
        form.elements.other.value = '13_glossy'; form.requestSubmit(); }`);
    await browser.until(`document.querySelector('.race .status').textContent.includes('relMSE')`, 30);
    const said = await browser.value(`document.querySelector('.race .status').textContent`);
    const [mis] = await browser.value(`[...document.querySelectorAll('.race polyline')].map(curve =>
        curve.getAttribute('points').split(' ').map(point => +point.split(',')[1]))`);
    check('the race has a reference, whatever the size of the picture', /relMSE.*64x64/s.test(said));
    check('two methods in equal time: the error of MIS falls, and it wins',
        mis.length > 5 && mis.at(-1) > mis[0] && parseFloat(said.match(/first is (\S+)/)[1]) > 2, said);
}

async function holding(browser) {
    await browser.open(page('15_mis_ris'));
    await browser.value(`document.querySelector('.hold').click()`);
    const [open, text] = await browser.value(`(() => { const d = document.querySelector('dialog');
        return [d.open, d.querySelector('canvas').getAttribute('aria-label')]; })()`);
    check('a picture of the page can be held', open && text.length > 0, text);
    const tiles = await browser.value(`[...document.querySelectorAll('dialog .choices button')].map(b => b.textContent)`);
    check('its tiles have names', tiles.length === 4 && tiles[0].includes('14, 40 samples') && tiles[3].includes('error of 15'),
        tiles.join('; '));
    await browser.value(`document.querySelector('dialog .close').click()`);
}

/// Formulas have the book's own font; text and figures can be read in light and in dark.
async function look(browser, dark) {
    await browser.dark(dark);
    await browser.open(page('14_mis'));
    const fonts = await browser.value(`document.fonts.load('16px "Book Math"').then(fonts => fonts.map(font => font.status))`);
    check('the font of formulas is in the book', fonts.length === 1 && fonts[0] === 'loaded');
    const contrast = await browser.value(`(() => { const shade = colour => { const [r, g, b] = colour.match(/[\\d.]+/g).map(v => (v / 255) ** 2.2);
        return 0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05; };
        const paper = shade(getComputedStyle(document.documentElement).backgroundColor), ratios = [];
        for (const node of document.querySelectorAll('main p, main a, main td, .sidebar a, .sourceCode .co, .sourceCode .kw, .sourceCode .st')) {
            const ink = shade(getComputedStyle(node).color);
            ratios.push(Math.max(ink, paper) / Math.min(ink, paper));
        } return [paper, Math.min(...ratios)]; })()`);
    check(`${dark ? 'dark' : 'light'}: the text stands out from the paper`, contrast[0] > 0.5 !== dark && contrast[1] > 4.5,
        `at least ${contrast[1].toFixed(1)} to 1`);
    const box = await box_of(browser, 'main img[src^="data:image/svg"]'), figure = await on_screen(browser, box);
    const light = figure.filter((v, i) => i % 4 === 1 && v > 200).length / (figure.length / 4);
    check(`${dark ? 'dark' : 'light'}: a figure has a light background`, light > 0.5, `${(100 * light).toFixed(0)} %`);
    await browser.dark(false);
}

async function searching(browser) {
    await browser.open(page('07_path_tracing'));
    await browser.value(`{ const form = document.querySelector('.sidebar .find');
        form.elements.q.value = 'Neyman 1934'; form.querySelector('button').click(); }`);
    await browser.until(`location.href.includes('search.html') && document.querySelector('.results a')`);
    const [first, said] = await browser.value(`[document.querySelector('.results a')?.href,
        document.querySelector('main .status').textContent]`);
    check('the search finds a word on its page', first?.includes('19_adaptive'), `${said}: ${first}`);
    const [target, anchor] = decodeURIComponent((first || '').slice(7)).split('#');
    check('its link leads to the section', fs.existsSync(target) && fs.readFileSync(target, 'utf8').includes(`id="${anchor}"`));
    await browser.value(`{ const q = document.querySelector('main input[name=q]'); q.value = 'xyzzyx'; q.oninput(); }`);
    const none = await browser.value(`[document.querySelectorAll('.results li').length, document.querySelector('main .status').textContent]`);
    check('the search says when it finds nothing', none[0] === 0 && none[1].includes('xyzzyx'), none[1]);
}

/// Two files of the reader's own, and what the program `compare` says of them.
async function own_pictures(browser) {
    const files = ['a', 'b'].flatMap((name, seed) => ['pfm', 'ppm', 'png'].map(kind => {
        const file = `${build}/book-test-${name}.${kind}`;
        execFileSync(`${build}/15_mis_ris`, ['scenes/cornell.pbrt', '--size', '48x32', '--spp', '4', '--seed', `${seed}`,
            '--out', file, '--quiet']);
        return file;
    }));
    const give = (k, file, bytes) => browser.value(`(() => { const all = new DataTransfer();
        all.items.add(new File([Uint8Array.from(atob('${bytes.toString('base64')}'), c => c.charCodeAt(0))], '${path.basename(file)}'));
        inputs[${k}].files = all.files; inputs[${k}].dispatchEvent(new Event('change')); })()`);
    for (const i of [0, 1, 2]) {
        const [a, b] = [files[i], files[i + 3]], kind = path.extname(a);
        await browser.open(`${book}/common/book/own_pictures.html`);
        check('there is no empty picture', !await browser.value(`viewer.node.checkVisibility()`));
        await give(0, a, fs.readFileSync(a));
        await give(1, b, fs.readFileSync(b));
        await browser.until(`said.textContent.includes('verdict:')`, 60);
        const here = (await browser.value('said.textContent')).trim();
        const native = String(execFileSync(`${build}/compare`, [a, b])).trim().replaceAll(a, `A/${path.basename(a)}`).replaceAll(b, `B/${path.basename(b)}`);
        const words = text => text.replace(/\s+/g, ' ');
        check(`two ${kind} files of the reader's own: the verdict of compare`, words(here) === words(native), here.split('\n').at(-1));
        const seen = await browser.value(`[viewer.pictures.length, viewer.pictures[0].width, viewer.pictures[0].pixels.filter(x => x > 0.01).length]`);
        check('and both are shown', seen[0] === 2 && seen[1] === 48 && seen[2] > 2000, `${seen}`);
    }
    await give(1, 'broken.pfm', Buffer.from('no picture'));
    await browser.until(`problem.textContent !== ''`);
    check('a file that is no picture is named', (await browser.value('problem.textContent')).includes('broken.pfm'));
    for (const file of files) fs.rmSync(file);
}

async function main() {
    check('the book has less than 20 MB', size() < 20e6, `${(size() / 1e6).toFixed(1)} MB`);
    for (const browser of [new Browser(chromium), ...(firefox ? [new Firefox(firefox)] : [])]) {
        console.log(`in ${browser.constructor === Firefox ? 'Firefox' : 'Chromium'}:`);
        try {
            await browser.start();
            await every_page(browser);
            await holding(browser);
            for (const dark of [false, true]) await look(browser, dark);
            await searching(browser);
            await own_pictures(browser);
            await by_keyboard(browser);
            await live(browser);
            await races(browser);
            await same_scenes(browser);
            await all_same_bytes(browser, await browser.value('chapters'));
            check('no error, and nothing asked of the network', browser.problems.length === 0,
                browser.problems.slice(0, 5).join('; '));
        } finally {
            await browser.close();
        }
    }
    console.log(failed === 0 ? 'the book does what it says' : `${failed} failed`);
    process.exitCode = failed === 0 ? 0 : 1;
}
main().catch(error => { console.log(`FAILED  ${error.message}`); process.exitCode = 1; });

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

/// Every page, wide and narrow: no error, no link to nowhere, no picture without words, none too wide.
async function every_page(browser) {
    const anchors = new Map(), links = [], bad = [];
    for (const width of [1200, 390]) {
        await browser.width(width);
        for (const file of pages()) {
            await browser.open(file);
            const seen = await browser.value(`({
                ids: [...document.querySelectorAll('[id]')].map(e => e.id),
                links: [...document.querySelectorAll('a[href]')].map(a => a.href),
                pictures: [...document.images].filter(i => !i.naturalWidth || !(i.alt || i.matches('.thumbnail'))).length,
                wide: document.documentElement.scrollWidth - innerWidth
            })`);
            anchors.set(file, new Set(seen.ids));
            if (width === 1200) links.push(...seen.links.map(link => [file, link]));
            const name = path.relative(book, file);
            if (seen.pictures > 0) bad.push(`${name}: ${seen.pictures} pictures are missing or have no words`);
            if (seen.wide > 0) bad.push(`${name}: ${seen.wide} pixels too wide for ${width}`);
        }
    }
    for (const [file, link] of links) {
        if (!link.startsWith('file://')) continue;
        const [target, anchor] = decodeURIComponent(link.slice(7)).split('#');
        const known = anchors.get(target);
        if (!known || (anchor && !known.has(anchor))) bad.push(`${path.relative(book, file)} links to ${link}`);
    }
    check(`${anchors.size} pages, 1200 and 390 pixels wide, and ${links.length} links`, bad.length === 0,
        bad.slice(0, 10).join('; '));
}

/// What a chapter makes in the page, with the form as `set` leaves it, and on the command line.
async function same_bytes(browser, chapter, set, args) {
    await browser.open(page(chapter));
    await browser.until(`document.querySelector('.go')`);
    await browser.value(`live.fill(${JSON.stringify(set)}); live.render().then(() => 0)`);
    const here = await browser.value(`Array.from(live.result?.['out/picture.pfm'] || [],
        byte => String.fromCharCode(byte)).join('')`);
    const file = `${build}/book-test.pfm`;
    execFileSync(`${build}/${chapter}`, [...args, '--out', file, '--quiet']);
    const native = fs.readFileSync(file).toString('latin1');
    fs.rmSync(file);
    check(`the same bytes as the program: ${chapter}`, here === native);
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
    await browser.width(1200);
    await browser.open(page('15_mis_ris'));
    await browser.until(`document.querySelector('.go')`);
    await browser.value(`live.fill({scene: 'cornell', spp: 4})`);
    await browser.value(`live.node.scrollIntoView(); document.querySelector('.go').click()`);
    const stays_free = await browser.value(`new Promise(free => { const t = performance.now();
        setTimeout(() => free(performance.now() - t), 20); })`);
    check('the page stays free while it renders', stays_free < 500, `${stays_free.toFixed(0)} ms for a timer of 20`);
    await browser.until(`live.first`);
    const first = await browser.value('live.first');
    check('first picture of 256x256, Cornell box', first < 2000, `after ${first.toFixed(0)} ms (busy machines: 2 s)`);
    await browser.until(`live.status.textContent.startsWith('done')`, 60);
    const values = await browser.value(`live.viewer.pictures[0].pixels.filter((x, i) => i % 4 === 0 && x > 0).length`);
    check('the picture is there', values > 30000);

    await path_story(browser);
    await layers_and_viewer(browser);
    await wrong_scene(browser);
    await browser.value(`live.fill({scene: 'thousand-lights', spp: 100000}); document.querySelector('.go').click()`);
    await browser.until(`live.first && live.status.textContent.includes('samples per pixel')`);
    await browser.value(`document.querySelector('.stop').click()`);
    await browser.until(`live.status.textContent.endsWith('stopped')`, 5);
    check('stop ends a long render', true);
}
async function path_story(browser) {
    const {x, y} = await browser.value(`(() => { live.viewer.canvas.scrollIntoView({block: 'center'});
        const box = live.viewer.canvas.getBoundingClientRect();
        return {x: box.x + box.width / 2, y: box.y + 0.8 * box.height}; })()`);
    await browser.click(x, y);
    await browser.until(`live.viewer.overlay.querySelector('svg circle')`);
    const story = await browser.value('live.text.textContent');
    const [, a, b] = story.match(/pixel (\d+),(\d+) sample 0/) || [];
    check('a click tells the path of its pixel', Math.abs(a - 128) <= 1 && Math.abs(b - 204) <= 1, `pixel ${a},${b}`);
    const off = await browser.value(`(() => { const box = live.viewer.overlay.querySelector('circle[fill="#c03"]')
        .getBoundingClientRect(); return [box.x + box.width / 2 - ${x}, box.y + box.height / 2 - ${y}]; })()`);
    check('its first vertex is drawn there', Math.hypot(...off) <= 4, `${off.map(Math.round)} pixels off`);
}
async function layers_and_viewer(browser) {
    await browser.value(`document.querySelector('.by-class button').click()`);
    await browser.until(`document.querySelectorAll('.layers button').length > 3`, 60);
    const shares = await browser.value(`[...document.querySelectorAll('.layers button')].map(b => b.textContent)`);
    const sum = shares.slice(1).reduce((s, text) => s + parseFloat(text.split(' ')[1]), 0);
    check('the classes of path sum to the picture', Math.abs(sum - 100) < 0.5, shares.slice(0, 5).join(', '));
    const before = await browser.value(`live.viewer.canvas.toDataURL()`);
    await browser.value(`live.viewer.canvas.focus()`);
    for (const [key, state] of [['e', 'exposure'], ['E', 'exposure'], ['d', 'error'], ['d', 'error'], ['z', 'zoom']]) {
        const old = await browser.value(`live.viewer.${state}`);
        await browser.key(key);
        check(`key ${key}`, old !== await browser.value(`live.viewer.${state}`));
    }
    await browser.value(`{ const range = live.viewer.range; range.value = 1; range.oninput(); live.viewer.draw(); }`);
    check('the slider changes the picture', before !== await browser.value(`live.viewer.canvas.toDataURL()`));
}
async function wrong_scene(browser) {
    await browser.value(`live.fill({scene: 'cornell', spp: 1}); live.editing.value =
        live.editing.value.replace('WorldBegin', 'WorldBegn'); document.querySelector('.go').click()`);
    await browser.until(`document.querySelector('.errors button')`);
    const [said, marked] = await browser.value(`[document.querySelector('.errors button').textContent,
        live.editing.value.slice(live.editing.selectionStart, live.editing.selectionEnd)]`);
    check('a mistake in the scene is named and marked', marked === 'WorldBegn', `${said} marks ${marked}`);
}

/// Samples a second in the page, with one worker and with two, beside the program with as many threads.
async function speed(browser) {
    const seconds = {}, spp = 64, picture = `${build}/book-test.pfm`;
    await browser.open(page('15_mis_ris'));
    await browser.until(`document.querySelector('.go')`);
    await browser.value(`live.fill({scene: 'cornell', size: '256x256', spp: ${spp}})`);
    const keep = (name, time) => { seconds[name] = Math.min(time, seconds[name] ?? time); };
    for (let round = 0; round < 3; round++) {
        for (const n of [1, 2]) {
            const begin = performance.now();
            execFileSync(`${build}/15_mis_ris`, ['scenes/cornell.pbrt', '--size', '256x256', '--spp', `${spp}`,
                '--threads', `${n}`, '--out', picture, '--quiet']);
            keep(`program ${n}`, (performance.now() - begin) / 1000);
            await browser.value(`Object.defineProperty(navigator, 'hardwareConcurrency', {value: ${n}, configurable: true});
                live.render().then(() => 0)`);
            keep(`page ${n}`, await browser.value(`(performance.now() - live.began) / 1000`));
        }
    }
    fs.rmSync(picture);
    const share = seconds['program 1'] / seconds['page 1'];
    check('one worker has a third of the speed of the program on one thread', share > 1 / 3,
        `${share.toFixed(2)} of it`);
    const gain = seconds['page 1'] / seconds['page 2'], native = seconds['program 1'] / seconds['program 2'];
    const busy = native < 1.7;
    check('two workers gain nearly what two threads of the program do', busy || gain > 0.7 * native,
        `${gain.toFixed(2)} times as fast as one; the program ${native.toFixed(2)} times` +
        (busy ? ': a busy machine, not judged' : ''));
}
function size(folder = book) {
    return fs.readdirSync(folder, {withFileTypes: true}).reduce((sum, entry) => sum + (entry.isDirectory()
        ? size(path.join(folder, entry.name)) : fs.statSync(path.join(folder, entry.name)).size), 0);
}

async function races(browser) {
    await browser.open(page('15_mis_ris'));
    await browser.until(`document.querySelector('.go')`);
    await browser.value(`live.fill({scene: 'veach-mis', size: '64x64'}); document.querySelector('.race').open = true;
        { const form = document.querySelector('.race form'); form.elements.time.value = 4;
        form.elements.other.value = '13_glossy'; form.requestSubmit(); }`);
    await browser.until(`document.querySelector('.race .status').textContent.includes('relMSE')`, 30);
    const said = await browser.value(`document.querySelector('.race .status').textContent`);
    const [mis] = await browser.value(`[...document.querySelectorAll('.race .curve')].map(curve =>
        curve.getAttribute('points').split(' ').map(point => +point.split(',')[1]))`);
    check('two methods in equal time: the error of MIS falls, and it wins',
        mis.length > 5 && mis.at(-1) > mis[0] && parseFloat(said.match(/first is (\S+)/)[1]) > 2, said);
}

async function holding(browser) {
    await browser.open(page('15_mis_ris'));
    await browser.value(`document.querySelector('.hold').click()`);
    const [open, text] = await browser.value(`(() => { const d = document.querySelector('dialog');
        return [d.open, d.querySelector('canvas').getAttribute('aria-label')]; })()`);
    check('a picture of the page can be held', open && text.length > 0, text);
    await browser.value(`document.querySelector('dialog .close').click()`);
    await browser.key('ArrowRight');
    await browser.until(`location.href.includes('16_lens_and_shutter')`);
    check('an arrow turns the page', true);
}

async function main() {
    check('the book has less than 15 MB', size() < 15e6, `${(size() / 1e6).toFixed(1)} MB`);
    for (const browser of [new Browser(chromium), ...(firefox ? [new Firefox(firefox)] : [])]) {
        console.log(`in ${browser.constructor === Firefox ? 'Firefox' : 'Chromium'}:`);
        try {
            await browser.start();
            await every_page(browser);
            await holding(browser);
            await live(browser);
            await races(browser);
            await all_same_bytes(browser, await browser.value('chapters'));
            await speed(browser);
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

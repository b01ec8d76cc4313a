// The book in headless browsers, from the file system and without a network: that its links lead somewhere, that all of it
// can be read, and that its live parts do what they say: each chapter makes the same bytes there as on the command line.
// Usage: node test.js BOOK BUILD, with puppeteer-core; in those of Chromium and Firefox that there are.
const {execFileSync, execSync} = require('child_process'), fs = require('fs'), path = require('path');
const puppeteer = require('puppeteer-core');
const [, , folder, build] = process.argv, book = path.resolve(folder);
const installed = names => String(execSync(`command -v ${names} | head -1`, {shell: '/bin/bash'})).trim();
const browsers = Object.entries({chrome: installed('chromium chromium-browser google-chrome'),
    firefox: installed('firefox-esr firefox')}).filter(([, program]) => program);

let failed = 0;
function check(claim, holds, detail = '') {
    console.log(`${holds ? 'ok      ' : 'FAILED  '}${claim}${detail && `: ${detail}`}`);
    if (!holds) failed++;
}
const all_files = fs.readdirSync(book, {recursive: true}).map(name => path.join(book, name))
    .filter(name => fs.statSync(name).isFile());
const open = (page, name) => page.goto(`file://${book}/${name}`);
const text = (page, selector) => page.$eval(selector, node => node.textContent);
async function chapter(page, name) {
    await open(page, `chapters/${name}/index.html`);
    await page.waitForSelector('.go');
}
const fill = (page, values) => page.evaluate(values => {
    for (const [name, value] of Object.entries(values)) {
        live.form.elements[name].value = value;
        live.form.elements[name].dispatchEvent(new Event('change'));
    }
}, values);
const done = page => page.waitForFunction(`live.status.textContent.startsWith('done') &&
    document.querySelector('.stop').disabled`);
function from_program(name, words, file) {
    execFileSync(`${build}/${name}`, [...words, '--out', file, '--quiet']);
    return file;
}

/// In the page: what is wrong with it, and its links. Contrast is that of each text and what is behind it.
function look() {
    const all = selector => [...document.querySelectorAll(selector)], style = node => getComputedStyle(node);
    const shade = color => {
        const [r, g, b] = color.match(/[\d.]+/g).map(v => (v / 255) ** 2.2);
        return 0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05;
    };
    const behind = node => {
        while (node.parentElement && style(node).backgroundColor.endsWith(', 0)')) node = node.parentElement;
        return style(node).backgroundColor;
    };
    const is_pale = node => {
        const shades = [shade(style(node).color), shade(behind(node))];
        return Math.max(...shades) < 4.5 * Math.min(...shades);
    };
    const has_text = node => [...node.childNodes].some(part => part.nodeType === 3 && part.data.trim());
    const texts = all('body *').filter(node => has_text(node) && node.checkVisibility() &&
        !node.matches('script, svg *, :disabled, math *'));
    const wrong = {
        'pictures without words': all('img').filter(img => img.loading !== 'lazy' && !img.naturalWidth ||
            !img.alt && !img.matches('.thumbnail')),
        'cut off': all('main table, main pre, .formula').filter(node => node.getBoundingClientRect().right > innerWidth ||
            node.scrollWidth > node.clientWidth + 1 && style(node).overflowX !== 'auto' || node.matches('.formula') &&
            node.offsetWidth > node.clientWidth),
        'labels beyond their figure': all('.figure text').filter(node => [node, node.closest('svg')]
            .map(part => part.getBoundingClientRect().right).reduce((label, edge) => label > edge + 1)),
        'too pale': texts.filter(is_pale),
        'too wide': document.documentElement.scrollWidth > innerWidth ? [document.body] : []
    };
    return {
        ids: all('[id]').map(node => node.id),
        links: all('a[href]').map(a => a.href),
        wrong: Object.entries(wrong).filter(([, nodes]) => nodes.length > 0)
            .map(([what, nodes]) => `${nodes.length} ${what}, such as ${nodes[0].outerHTML.slice(0, 80)}`)
    };
}
async function every_page(page, is_chrome) {
    const anchors = new Map(), links = [], bad = [];
    for (const [width, value] of [[1280, 'light'], [390, 'dark']]) {
        await page.setViewport({width, height: 900});
        if (is_chrome) await page.emulateMediaFeatures([{name: 'prefers-color-scheme', value}]);
        for (const file of all_files.filter(name => name.endsWith('.html'))) {
            await page.goto(`file://${file}`);
            const seen = await page.evaluate(look), name = path.relative(book, file);
            anchors.set(file, new Set(seen.ids));
            links.push(...seen.links.map(link => [name, link]));
            bad.push(...seen.wrong.map(what => `${name}, ${width} wide, ${value}: ${what}`));
        }
    }
    for (const [name, link] of links.filter(([, link]) => link.startsWith('file://'))) {
        const [target, anchor] = decodeURIComponent(link.slice(7)).split('#');
        if (!anchors.has(target) || anchor && !anchors.get(target).has(anchor)) bad.push(`${name} links to ${link}`);
    }
    check(`${anchors.size} pages, on a desk and on a phone, and their links`, bad.length === 0, bad.slice(0, 20).join('\n'));
    await page.setViewport({width: 1280, height: 900});
}

/// Clicks on Render as the page comes.
async function same_bytes(page, name) {
    await chapter(page, name);
    await page.click('.go');
    await done(page);
    const [words, took, bytes, lit] = await page.evaluate(() => {
        const {canvas} = live.viewer, {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
        const bytes = Array.from(live.result['out/picture.pfm'], byte => String.fromCharCode(byte)).join('');
        return [live.words(), live.status.textContent, bytes, data.filter((v, i) => i % 4 === 1 && v > 16).length / data.length];
    });
    const file = from_program(name, words, `${build}/book-test.pfm`), same = bytes === fs.readFileSync(file).toString('latin1');
    check(`Render makes the bytes of the program: ${name}`, same && lit > 0.01, took);
}

/// Tab reaches all that a mouse can use, with a frame around it, and Enter renders.
async function by_keyboard(page) {
    await chapter(page, '15_mis_ris');
    await fill(page, {scene: 'cornell', size: '24x24', spp: 1});
    await page.evaluate(() => {
        for (const part of document.querySelectorAll('details')) part.open = true;
        window.left = new Set([...document.querySelectorAll('a[href], button, input, select, textarea, summary, [tabindex="0"]')]
            .filter(node => node.checkVisibility() && !node.disabled && !node.closest('dialog')));
    });
    const count = await page.evaluate('left.size'), bare = [];
    for (let presses = 0; presses < count + 50 && await page.evaluate('left.size'); presses++) {
        await page.keyboard.press('Tab');
        const frame = await page.evaluate(() => {
            const node = document.activeElement;
            return left.delete(node) && getComputedStyle(node).outlineStyle === 'none' && node.outerHTML.slice(0, 60);
        });
        if (frame) bare.push(frame);
    }
    const missed = await page.evaluate('[...left].map(node => node.outerHTML.slice(0, 60))');
    check(`Tab reaches all ${count} links, buttons and fields, and frames them`, missed.length + bare.length === 0,
        [...missed, ...bare].slice(0, 5).join(' '));
    await page.focus('.go');
    await page.keyboard.press('Enter');
    await done(page);
}

/// The path of a pixel by click and by keys; classes of paths; a mistake in the scene; stopping.
async function live_part(page) {
    await chapter(page, '15_mis_ris');
    await page.waitForFunction('live.viewer.pictures.length === 4 && live.viewer.canvas.checkVisibility()');
    await fill(page, {scene: 'cornell', spp: 4});
    await page.click('.go');
    await done(page);
    await page.click('.live canvas');
    await page.waitForSelector('.overlay svg circle');
    const story = await text(page, '.live .printed');
    check('a click tells the path of its pixel', /pixel 12[78],12[78] sample 0/.test(story), story.slice(0, 40));
    await page.evaluate('live.viewer.overlay.replaceChildren()');
    await page.focus('.live canvas');
    for (const key of ['ArrowDown', 'ArrowDown', 'ArrowRight', 'Enter']) await page.keyboard.press(key);
    await page.waitForSelector('.overlay svg circle');
    check('arrow keys and Enter do, too', (await text(page, '.live .printed')).includes('pixel 129,130 sample 0'));

    await page.click('.by-class button');
    await page.waitForFunction(`document.querySelectorAll('.layers button').length > 3`);
    const shares = await page.$$eval('.layers button', list => list.map(button => button.textContent));
    const sum = shares.slice(1).reduce((s, share) => s + parseFloat(share.split(' ')[1]), 0);
    check('the classes of paths sum to the picture', Math.abs(sum - 100) < 0.5, shares.slice(0, 5).join(', '));
    const before = await page.evaluate('live.viewer.canvas.toDataURL()');
    await page.focus('.live input[type=range]');
    await page.keyboard.press('End');
    check('the slider changes the picture', before !== await page.evaluate('live.viewer.canvas.toDataURL()'));

    await page.evaluate(`live.editing.value = live.editing.value.replace('WorldBegin', 'WorldBegn')`);
    await page.click('.go');
    await page.waitForSelector('.errors li');
    const said = await text(page, '.errors');
    check('a mistake in the scene is named with its place', /cornell\.pbrt:\d+:\d+: .*WorldBegn/.test(said), said);
    await fill(page, {scene: 'thousand-lights', spp: 100000});
    await page.click('.go');
    await page.waitForFunction(`live.status.textContent.includes('samples per pixel')`);
    await page.click('.stop');
    await page.waitForFunction(`live.status.textContent.endsWith('stopped')`, {timeout: 5000});
}
async function race(page) {
    await chapter(page, '15_mis_ris');
    await fill(page, {scene: 'veach-mis'});
    await page.evaluate(() => {
        document.querySelector('.race').open = true;
        const form = document.querySelector('.race form'), {time, other} = form.elements;
        time.value = 4, other.value = '13_glossy';
        form.requestSubmit();
    });
    await page.waitForFunction(`document.querySelector('.race .status').textContent.includes('relMSE')`);
    const said = await text(page, '.race .status');
    check('two methods in equal time: MIS wins', parseFloat(said.match(/first is (\S+)/)[1]) > 2, said);
}
async function pictures(page) {
    await chapter(page, '15_mis_ris');
    await page.click('.hold');
    const tiles = await page.$$eval('dialog .choices button', list => list.map(button => button.textContent));
    check('a picture of the page opens, and its tiles have names', tiles.length === 4 && tiles[3].includes('error of 15'),
        tiles.join('; '));
}
async function searching(page) {
    await open(page, 'chapters/07_path_tracing/index.html');
    await page.type('.sidebar .find input', 'Neyman 1934\n');
    await page.waitForSelector('.results a');
    const first = await page.$eval('.results a', a => a.href);
    check('the search finds words on their page', first.includes('19_adaptive'), first);
    const search = word => page.$eval('main input[name=q]', (input, word) => { input.value = word, input.oninput(); }, word);
    await search('MIS');
    check('it finds whole words, those of the glossary first', await text(page, '.results a') === 'Glossary: MIS');
    await search('xyzzyx');
    const said = await text(page, 'main .status');
    check('it says when it finds nothing', said.includes('xyzzyx') && !await page.$('.results a'), said);
    await open(page, 'chapters/09_light_sampling/index.html');
    await page.hover('a[data-tip]');
    const tip = await page.$eval('a[data-tip]', word => getComputedStyle(word, '::after').content !== 'none' && word.dataset.tip);
    check('a word of the glossary shows its meaning', tip.length > 20, tip);
}

async function main() {
    if (browsers.length === 0 || !fs.existsSync(`${book}/book/data.js`)) {
        return console.log('SKIPPED: no browser, or the book has no live part, since there is no em++');
    }
    const size = all_files.reduce((sum, name) => sum + fs.statSync(name).size, 0) / 1e6;
    check('the book has at most 15 MB', size < 15, `${size.toFixed(1)} MB`);
    for (const [kind, executablePath] of browsers) {
        console.log(`in ${kind}:`);
        const is_chrome = kind === 'chrome', args = is_chrome ? ['--no-sandbox', '--host-resolver-rules=MAP * ~NOTFOUND'] : [];
        const browser = await puppeteer.launch({browser: kind, executablePath, args}), page = await browser.newPage(), problems = [];
        page.setDefaultTimeout(180000);
        page.on('pageerror', error => problems.push(error.message));
        page.on('console', message => message.type() === 'error' && problems.push(message.text()));
        page.on('request', request => /^(http|ws|ftp)/.test(request.url()) && problems.push(`asks for ${request.url()}`));
        await every_page(page, is_chrome);
        for (const part of [pictures, searching, by_keyboard, live_part, race]) await part(page);
        for (const name of Object.keys(await page.evaluate('chapters'))) await same_bytes(page, name);
        check('no error, and nothing asked of the network', problems.length === 0, problems.slice(0, 5).join('; '));
        await browser.close();
    }
    console.log(failed === 0 ? 'the book does what it says' : `${failed} failed`);
    process.exit(failed === 0 ? 0 : 1);
}
main().catch(error => {
    console.log(`FAILED  ${error.stack}`);
    process.exit(1);
});

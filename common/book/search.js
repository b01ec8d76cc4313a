// The search page. `sections` holds the text of all pages, section by section: [address, page, heading, text].

/// Sections that contain all words; those with a word in a heading come first, then those with the most.
function search(words) {
    const found = [];
    for (const [address, page, heading, text] of sections) {
        const title = `${page} ${heading}`.toLowerCase(), body = text.toLowerCase();
        let score = 0;
        for (const word of words) {
            const count = Math.min(5, body.split(word).length - 1), titled = title.includes(word);
            if (count === 0 && !titled) { score = 0; break; }
            score += count + (titled ? 20 : 0);
        }
        if (score > 0) found.push({score, address, page, heading, text});
    }
    return found.sort((a, b) => b.score - a.score);
}
/// The text around the first of the words, with all words marked.
function excerpt(text, words) {
    const first = Math.min(...words.map(word => text.toLowerCase().indexOf(word)).filter(at => at >= 0), text.length);
    const from = Math.max(0, text.lastIndexOf(' ', Math.max(0, first - 60)));
    const part = text.slice(from, from + 200), node = document.createElement('p');
    for (let rest = part; rest;) {
        const lower = rest.toLowerCase();
        const hits = words.map(word => [lower.indexOf(word), word.length]).filter(([at]) => at >= 0).sort((a, b) => a[0] - b[0]);
        const [at, length] = hits[0] || [rest.length, 0];
        const mark = document.createElement('mark');
        mark.textContent = rest.slice(at, at + length);
        node.append(rest.slice(0, at), ...length ? [mark] : []);
        rest = rest.slice(at + length);
    }
    return node;
}
function show(query) {
    const words = query.toLowerCase().match(/\S+/g) || [], found = words.length ? search(words) : [];
    document.querySelector('main .status').textContent = words.length === 0 ? '' :
        found.length === 0 ? `No section contains all of: ${words.join(', ')}` :
        `${found.length} section${found.length > 1 ? 's' : ''}${found.length > 30 ? '; the first 30' : ''}`;
    document.querySelector('.results').replaceChildren(...found.slice(0, 30).map(({address, page, heading, text}) => {
        const item = document.createElement('li'), link = document.createElement('a');
        link.href = document.body.dataset.root + address;
        link.textContent = heading && heading !== page ? `${page}: ${heading}` : page;
        item.append(link, excerpt(text, words));
        return item;
    }));
}
const input = document.querySelector('main input[name=q]');
document.querySelector('main form').onsubmit = event => {
    event.preventDefault();
    history.replaceState(null, '', `?q=${encodeURIComponent(input.value)}`);
    show(input.value);
};
input.oninput = () => show(input.value);
input.value = new URLSearchParams(location.search).get('q') || '';
show(input.value);

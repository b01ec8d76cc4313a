// The search page. `sections` holds the text of all pages, section by section: [address, page, heading, text].

/// One of the words, whole.
const whole = words => {
    const escaped = words.map(word => word.replace(/[\\^$.*+?()[\]{}|/]/g, '\\$&'));
    return RegExp(`(?<![\\p{L}\\d_])(${escaped.join('|')})(?![\\p{L}\\d_])`, 'giu');
};
/// Sections that contain all words: those of the glossary first, then those with a word in a heading, then the others.
function search(words) {
    return sections.map(([address, page, heading, text]) => {
        const bonus = page === 'Glossary' ? 100 : 20;
        const scores = words.map(word => whole([word])).map(word => Math.min(5, text.match(word)?.length || 0) +
            (`${page} ${heading}`.match(word) ? bonus : 0));
        return {score: Math.min(...scores) && scores.reduce((sum, x) => sum + x), address, page, heading, text};
    }).filter(({score}) => score > 0).sort((a, b) => b.score - a.score);
}
/// The text around the first of the words, with all words marked.
function excerpt(text, words) {
    const from = Math.max(0, text.lastIndexOf(' ', Math.max(0, text.search(whole(words)) - 60)));
    const parts = text.slice(from, from + 200).split(whole(words));
    return make('p', {}, ...parts.map((part, i) => i % 2 ? make('mark', {}, part) : part));
}
function show(query) {
    const words = query.toLowerCase().match(/\S+/g) || [], found = words.length ? search(words) : [];
    document.querySelector('main .status').textContent = words.length === 0 ? '' :
        found.length === 0 ? `No section contains all of: ${words.join(', ')}` :
        `${found.length} section${found.length > 1 ? 's' : ''}${found.length > 30 ? '; the first 30' : ''}`;
    document.querySelector('.results').replaceChildren(...found.slice(0, 30).map(({address, page, heading, text}) => make('li', {},
        make('a', {href: document.body.dataset.root + address}, heading && heading !== page ? `${page}: ${heading}` : page),
        excerpt(text, words))));
}
const input = document.querySelector('main input[name=q]');
document.querySelector('main form').onsubmit = event => {
    event.preventDefault();
    history.replaceState(null, '', `?q=${encodeURIComponent(input.value)}`);
};
input.oninput = () => show(input.value);
input.value = new URLSearchParams(location.search).get('q') || '';
show(input.value);

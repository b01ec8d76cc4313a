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

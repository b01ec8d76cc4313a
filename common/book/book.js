// Keys and the sidebar, on every page.

// Each section can be linked to.
for (const heading of document.querySelectorAll('main :is(h2, h3, h4)[id]')) {
    const mark = document.createElement('a');
    mark.href = `#${heading.id}`, mark.className = 'anchor', mark.textContent = '#';
    mark.setAttribute('aria-label', 'link to this section');
    heading.append(' ', mark);
}

// Arrows turn pages, but where they move something else.
document.addEventListener('keydown', event => {
    const busy = event.target.closest('input, select, textarea, dialog[open], canvas, pre, summary');
    if (busy || event.altKey || event.ctrlKey || event.metaKey || event.shiftKey) return;
    const rel = {ArrowLeft: 'prev', ArrowRight: 'next'}[event.key];
    const link = rel && document.querySelector(`.turn a[rel=${rel}]`);
    if (link) location.href = link.href;
});

// On a phone the sidebar begins closed.
if (matchMedia('(max-width: 60rem)').matches) document.querySelector('.sidebar').open = false;

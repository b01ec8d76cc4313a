// Each section can be linked to.
for (const heading of document.querySelectorAll('main :is(h2, h3, h4)[id]')) {
    const mark = document.createElement('a');
    mark.href = `#${heading.id}`, mark.className = 'anchor', mark.textContent = '#';
    mark.setAttribute('aria-label', 'link to this section');
    heading.append(' ', mark);
}

// On a phone the sidebar begins closed.
if (matchMedia('(max-width: 60rem)').matches) document.querySelector('.sidebar').open = false;

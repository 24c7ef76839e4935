// Making elements: the page has no framework.

const svgSpace = "http://www.w3.org/2000/svg";

function fill(element, attributes, children) {
    for (const [name, value] of Object.entries(attributes)) {
        if (value === undefined || value === null || value === false) continue;
        if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
        else element.setAttribute(name, value === true ? "" : value);
    }
    element.append(...children.filter((child) => child !== null && child !== undefined));
    return element;
}

/** An HTML element; attributes "onclick" and the like are functions. */
export function make(tag, attributes = {}, ...children) {
    return fill(document.createElement(tag), attributes, children);
}

/** An SVG element. */
export function draw(tag, attributes = {}, ...children) {
    return fill(document.createElementNS(svgSpace, tag), attributes, children);
}

export function byId(id) {
    return document.getElementById(id);
}

/** Sets a text only where it changes, so that screen readers are told of news alone. */
export function say(element, text) {
    if (element.textContent !== text) element.textContent = text;
}

/** Sets a class among others: `state` of "fix", "nofix" … */
export function mark(element, name, value) {
    if (element.dataset[name] !== String(value)) element.dataset[name] = value;
}

/** Where the user is typing, letters are letters. */
export function isTyping(target) {
    return target instanceof HTMLElement && (target.isContentEditable || /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName));
}

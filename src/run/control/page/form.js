// Fields for the parameters of a fault or a command, from the program's own table.
import { make } from "./dom.js";
import { words } from "./format.js";

// Units stand at the end of a parameter's name; these say them as people write them.
const units = {
    s: "s", m: "m", ms: "ms", us: "µs", ns: "ns", db: "dB", dbhz: "dB-Hz", deg: "°", mps: "m/s", mps2: "m/s²", hz: "Hz",
    khz: "kHz", mhz: "MHz", ppm: "ppm", ppb: "ppb", percent: "%", bytes: "bytes", baud: "bit/s", km: "km", dbm: "dBm",
    bps: "bit/s", w: "W", tecu: "TECU", dbw: "dBW", v: "V", ma: "mA", min: "min", h: "h",
};

/** "j_s_db" -> {label: "j s", unit: "dB"}. */
export function labelOf(name) {
    const parts = name.split("_");
    const unit = parts.length > 1 ? units[parts.at(-1)] : name === "baud" ? units.baud : undefined;
    return { label: words(unit && parts.length > 1 ? parts.slice(0, -1).join("_") : name), unit };
}

function range(spec) {
    if (spec.least === undefined && spec.most === undefined) return "";
    const number = (value) => (Math.abs(value) >= 1e6 ? value.toExponential().replace("e+", "e") : String(value));
    if (spec.most === undefined || (spec.least === 0 && spec.most >= 1e6)) return `from ${number(spec.least)}`;
    return spec.least === undefined ? `up to ${number(spec.most)}` : `${number(spec.least)} to ${number(spec.most)}`;
}

// Each maker returns {element, read()}; read() gives undefined for what is left to the program.

function numberField(spec, id) {
    const input = make("input", {
        id, type: "text", inputmode: "decimal", autocomplete: "off", required: spec.needed,
        value: spec.standard ?? "", placeholder: spec.needed ? "needed" : "not set",
    });
    const read = () => {
        const text = input.value.trim().replace("−", "-");
        if (text === "") {
            if (spec.needed) throw new Error("a number is needed");
            return undefined;
        }
        const value = Number(text.replace(",", "."));
        if (!Number.isFinite(value)) throw new Error(`'${text}' is no number`);
        if (value < (spec.least ?? -Infinity) || value > (spec.most ?? Infinity))
            throw new Error(`${text} is not from ${range(spec).replace("from ", "")}`);
        return value;
    };
    return { element: input, read };
}

function flagField(spec, id) {
    const input = make("input", { id, type: "checkbox", checked: spec.standard === true });
    return { element: input, read: () => input.checked };
}

function wordField(spec, id) {
    const none = spec.standard === null || spec.standard === "";
    const options = spec.choices.map((choice) =>
        make("option", { value: choice, selected: choice === spec.standard }, words(choice)));
    const select = make("select", { id }, none ? make("option", { value: "" }, "not set") : null, ...options);
    return { element: select, read: () => (select.value === "" ? undefined : select.value) };
}

function wordsField(spec, id) {
    const standard = spec.standard ?? [];
    const boxes = spec.choices.map((choice) =>
        make("input", { type: "checkbox", value: choice, checked: standard.includes(choice) }));
    const element = make("span", { class: "choices", id, role: "group" },
        ...boxes.map((box) => make("label", { class: "choice" }, box, words(box.value))));
    const read = () => {
        const chosen = boxes.filter((box) => box.checked).map((box) => box.value);
        return chosen.length ? chosen : undefined;
    };
    return { element, read };
}

function textField(spec, id) {
    const input = make("input", {
        id, type: "text", autocomplete: "off", spellcheck: "false", maxlength: 1000,
        value: spec.standard ?? "", placeholder: "not set",
    });
    return { element: input, read: () => (input.value.trim() === "" ? undefined : input.value.trim()) };
}

function textsField(spec, id) {
    const field = textField({ ...spec, standard: (spec.standard ?? []).join(", ") }, id);
    field.element.placeholder = "several with commas";
    const read = () => field.read()?.split(",").map((text) => text.trim()).filter(Boolean);
    return { element: field.element, read };
}

function numbersField(spec, id) {
    const field = textField({ ...spec, standard: (spec.standard ?? []).join(", ") }, id);
    field.element.placeholder = spec.needed ? "needed: numbers with commas" : "numbers with commas";
    const read = () => {
        const text = field.read();
        if (text === undefined && spec.needed) throw new Error("numbers are needed");
        const values = text?.split(/[,;\s]+/).filter(Boolean).map(Number);
        if (values?.some((value) => !Number.isFinite(value))) throw new Error(`'${text}' is no list of numbers`);
        if (values && (values.length < spec.count_least || values.length > (spec.count_most ?? Infinity)))
            throw new Error(`${values.length} numbers; expected ${spec.count_least}` +
                (spec.count_most === spec.count_least ? "" : " or more"));
        return values;
    };
    return { element: field.element, read };
}

const makers = {
    number: numberField, whole_number: numberField, flag: flagField, word: wordField, words: wordsField, text: textField, texts: textsField,
    numbers: numbersField,
};
const isNumber = (spec) => spec.type === "number" || spec.type === "whole_number";

function rowOf(spec, index) {
    const id = `parameter-${index}-${spec.name}`;
    const field = makers[spec.type](spec, id);
    field.element.setAttribute("aria-describedby", `${id}-note`);
    const { label, unit } = labelOf(spec.name);
    const note = make("small", { id: `${id}-note` },
        [spec.meaning, isNumber(spec) ? range(spec) : ""].filter(Boolean).join("; "));
    const mistake = make("small", { class: "mistake", role: "alert" });
    const element = make("div", { class: `field field-${spec.type}` }, make("label", { for: id }, label),
        make("span", { class: "input" }, field.element, unit ? make("span", { class: "unit" }, unit) : null), note, mistake);
    return { spec, element, field, mistake };
}

/**
 * Fields for tables of parameters.
 * @param groups [{title, specs}]; one with a title is folded away
 * @returns {elements, read()}; read() gives an object of the values that differ from being left out, or null after it has
 *          shown what is wrong
 */
export function formFor(groups) {
    const rows = [];
    const elements = groups.filter(({ specs }) => specs.length).flatMap(({ title, specs }) => {
        const made = specs.map((spec, index) => rowOf(spec, rows.length + index));
        rows.push(...made);
        const fields = made.map((row) => row.element);
        return title ? [make("details", { class: "more" }, make("summary", {}, title), ...fields)] : fields;
    });
    const read = () => {
        const values = {};
        let first = null;
        for (const { spec, field, mistake } of rows) {
            mistake.textContent = "";
            try {
                const value = field.read();
                if (value !== undefined) values[spec.name] = value;
            } catch (error) {
                mistake.textContent = error.message;
                const folded = field.element.closest("details");
                if (folded) folded.open = true;
                first ??= field.element;
            }
        }
        first?.focus();
        return first ? null : values;
    };
    return { elements, read };
}

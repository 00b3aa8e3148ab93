// Values of RON as the pipeline files write them: enough to read a parameter, and to write it anew.
//
// read("[Sew(a: \"front.side\", b: \"back.side\")]")
//     -> { kind: "list", items: [{ kind: "call", name: "Sew", fields: { a: {kind: "text", value: "front.side"}, ...}}] }
//
// Each value has `start` and `end`, its place in the text. Comments are skipped.

export class RonError extends Error {}

class Reader {
    constructor(text) {
        this.text = text;
        this.at = 0;
    }

    /** Skips white space and comments; gives the next character. */
    next() {
        const blank = /(?:\s+|\/\/[^\n]*|\/\*[^]*?\*\/)*/y;
        blank.lastIndex = this.at;
        blank.exec(this.text);
        this.at = blank.lastIndex;
        return this.text[this.at];
    }

    take(what) {
        if (this.next() !== what) throw new RonError(`expected ${what} at ${this.at}`);
        this.at += 1;
    }

    match(pattern) {
        pattern.lastIndex = this.at;
        const found = pattern.exec(this.text);
        if (found) this.at = pattern.lastIndex;
        return found?.[0];
    }

    value() {
        const first = this.next();
        const start = this.at;
        const made = this.valueFrom(first);
        return { ...made, start, end: this.at };
    }

    valueFrom(first) {
        if (first === '"') return { kind: "text", value: this.string() };
        if (first === "[") return { kind: "list", items: this.between("[", "]", () => this.value()) };
        if (first === "{") return { kind: "map", entries: this.between("{", "}", () => this.entry()) };
        if (first === "(") return { kind: "call", name: "", ...this.fields() };
        const raw = this.match(/r#[A-Za-z_]\w*/y);
        if (raw) return { kind: "name", value: raw.slice(2) };
        const name = this.match(/[A-Za-z_]\w*/y);
        if (name)
            return this.next() === "("
                ? { kind: "call", name, ...this.fields() }
                : { kind: "name", value: name };
        const number = this.match(/[-+]?[\d._]+(?:[eE][-+]?\d+)?/y);
        if (number) return { kind: "number", value: Number(number.replaceAll("_", "")) };
        throw new RonError(`no value at ${this.at}`);
    }

    string() {
        const quoted = this.match(/"(?:[^"\\]|\\[^])*"/y);
        if (quoted === undefined) throw new RonError(`a text without end at ${this.at}`);
        return quoted
            .slice(1, -1)
            .replace(/\\(["\\/])/g, "$1")
            .replaceAll("\\n", "\n");
    }

    between(open, close, item) {
        this.take(open);
        const items = [];
        while (this.next() !== close) {
            items.push(item());
            if (this.next() === ",") this.at += 1;
            else break;
        }
        this.take(close);
        return items;
    }

    entry() {
        const key = this.value();
        this.take(":");
        return [key.value, this.value()];
    }

    /** Named fields and values without a name, as `Preset(name: "linen")` and `(0.1, 0.2)` have them. */
    fields() {
        const fields = {};
        const items = [];
        this.between("(", ")", () => {
            this.next();
            const here = this.at;
            const name = this.match(/(?:r#)?[A-Za-z_]\w*/y);
            if (name && this.next() === ":") {
                this.at += 1;
                fields[name.replace("r#", "")] = this.value();
            } else {
                this.at = here;
                items.push(this.value());
            }
        });
        return { fields, items };
    }
}

/** Reads one value; throws RonError where the text is none. */
export function read(text) {
    const reader = new Reader(text);
    const value = reader.value();
    if (reader.next() !== undefined) throw new RonError(`text after the value at ${reader.at}`);
    return value;
}

/** Reads a value, nothing where there is none or it cannot be read. */
export function tryRead(text) {
    try {
        return text ? read(text) : null;
    } catch (error) {
        if (error instanceof RonError) return null;
        throw error;
    }
}

/** The texts of a list's items, as they are written. */
export const itemsOf = (text) => (tryRead(text)?.items ?? []).map((item) => text.slice(item.start, item.end));

export const quote = (text) => `"${text.replace(/[\\"]/g, "\\$&")}"`;

/** A number as RON writes it: at most `digits` after the point, no exponent. */
export const number = (value, digits = 4) => String(Number(value.toFixed(digits)));

export const list = (items) => `[${items.join(", ")}]`;

/** A map of places: {"front": [(0.1, 0.2), ...]}. */
export const map = (entries) => `{${entries.map(([key, value]) => `${quote(key)}: ${value}`).join(", ")}}`;

export const pair = (x, y) => `(${number(x)}, ${number(y)})`;

// Places in a text: the program counts bytes of UTF-8, the page counts UTF-16 units.

const encoder = new TextEncoder();

/** The index in `text` of a byte of its UTF-8 form. */
export function indexOfByte(text, byte) {
    let bytes = 0;
    let index = 0;
    for (const char of text) {
        if (bytes >= byte) return index;
        bytes += char.codePointAt(0) < 0x80 ? 1 : encoder.encode(char).length;
        index += char.length;
    }
    return index;
}

/** Line and column of an index, both from 1. */
export function lineOf(text, index) {
    const before = text.slice(0, index).split("\n");
    return { line: before.length, column: before.at(-1).length + 1 };
}

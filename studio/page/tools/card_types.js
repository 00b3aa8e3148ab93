// What a card says of a parameter, as the page needs it. Types are written for people: "length (or None)",
// "Nothing | Mirror", "None | Propose | Auto(max_strain: ...)".

/** Parts of a type that stand beside each other, not those within brackets. */
function alternatives(type) {
    const parts = [""];
    let depth = 0;
    for (const char of type) {
        if ("([{".includes(char)) depth += 1;
        if (")]}".includes(char)) depth -= 1;
        if (char === "|" && depth === 0) parts.push("");
        else parts[parts.length - 1] += char;
    }
    return parts.map((part) => part.trim());
}

const plainType = (param) => param.type.replace(/\s*\(or None\)$/, "");

/** "switch", "choice", "length", "number", "whole" or "text". */
export function kindOf(param) {
    const type = plainType(param);
    if (type === "true | false") return "switch";
    if (type === "length") return "length";
    if (type === "number") return "number";
    if (type === "whole number") return "whole";
    if (type.includes("|") && alternatives(type).length > 1 && !/^(list|\{)/.test(type)) return "choice";
    return namesIn(param).length > 0 ? "names" : "text";
}

/** The names that a choice has, without what they carry. */
export const choicesOf = (param) =>
    alternatives(plainType(param)).map((part) => part.replace(/\(.*$/s, "").replace("r#", ""));

/** Whether a choice carries more than its name. */
export const carries = (param, name) =>
    alternatives(plainType(param)).some((part) => part.startsWith(`${name}(`));

export const mayBeNone = (param) => /\(or None\)$/.test(param.type);

/** Names that a card's text lists, as `Preset` lists its cloths: "Names: linen, denim." */
export function namesIn(param, card) {
    if (param.choices) return param.choices;
    if (plainType(param) !== "text" || !card) return [];
    const found = /Names: ([^.]+)\./.exec(card.doc);
    return found && param.name === "name" ? found[1].split(",").map((name) => name.trim()) : [];
}

/** A default as it is written in a file. */
export const written = (value) => (value ?? "").replaceAll("r#", "");

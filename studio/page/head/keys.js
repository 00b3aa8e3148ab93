// Keys of the whole page: Ctrl+Z, Ctrl+Shift+Z (or Ctrl+Y), Ctrl+S; Escape takes the selection back.

import { redo, save, undo } from "../server/edits.js";
import { choose } from "../server/selection.js";
import { tell } from "../server/store.js";

/** Where someone types, Ctrl+Z takes back letters while they have not been taken yet. */
const isTyping = (el) =>
    (el.matches?.("textarea, input[type=text], input[type=number]") ?? false) && el.dataset.typed === "true";

export function listenToKeys() {
    addEventListener("keydown", (event) => {
        const command = event.ctrlKey || event.metaKey;
        const key = event.key.toLowerCase();
        if (command && key === "s") {
            event.preventDefault();
            // What is being typed is taken first.
            document.activeElement?.dispatchEvent(new Event("commit"));
            save();
        } else if (command && (key === "z" || key === "y") && !isTyping(event.target)) {
            event.preventDefault();
            if (key === "y" || event.shiftKey) redo();
            else undo();
        } else if (event.key === "Escape") {
            choose();
            tell("escape");
        }
    });
}

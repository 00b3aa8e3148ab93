// The studio's page: head, three panes (photo, pattern, garment) and the tools below them. Each part mounts itself
// once and redraws what depends on the store when the store tells that it changed.

import { followLanguage } from "./words/card_texts.js";
import { words } from "./words/words.js";
import { mountHead } from "./head/head.js";
import { mountStatus } from "./head/status.js";
import { mountRemedies } from "./head/remedies.js";
import { mountBegin } from "./begin/begin.js";
import { mountWork } from "./layout.js";
import { keepInStep } from "./server/live.js";
import { listenToKeys } from "./head/keys.js";
import { restoreTheme } from "./head/theme.js";

restoreTheme();
words.restore();
followLanguage();
mountHead(document.getElementById("head"));
mountStatus(document.getElementById("foot"), document.getElementById("lost"));
mountRemedies(document.getElementById("foot"));
mountBegin(document.getElementById("begin"));
mountWork(document.getElementById("work"));
listenToKeys();
keepInStep();

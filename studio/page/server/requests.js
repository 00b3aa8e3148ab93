// Requests to the program that serves this page. A refusal is an error with the program's own words and hint.

export class Refusal extends Error {
    constructor(status, { code = "unknown", message = `HTTP ${status}`, hint = null, faults = [] } = {}) {
        super(message);
        Object.assign(this, { status, code, hint, faults });
    }

    get words() {
        return this.hint ? `${this.message} (${this.hint})` : this.message;
    }
}

async function ask(path, options = {}) {
    const answer = await fetch(path, { credentials: "same-origin", ...options });
    if (answer.ok) return answer;
    const body = await answer.json().catch(() => ({}));
    throw new Refusal(answer.status, body.error);
}

export const getJson = async (path) => (await ask(path)).json();

/** The bytes of a file, nothing where there is none. */
export async function getBytes(path) {
    try {
        return await (await ask(path)).arrayBuffer();
    } catch (error) {
        if (error.status === 404) return null;
        throw error;
    }
}

export async function postJson(path, body = {}) {
    const headers = { "Content-Type": "application/json" };
    return (await ask(path, { method: "POST", headers, body: JSON.stringify(body) })).json();
}

/** Keeps a file in the project's folder; answers with the name that it has there. */
export async function upload(file) {
    const name = file.name.replace(/[^A-Za-z0-9_. -]/g, "_").replace(/^\.+/, "") || "file";
    const headers = { "Content-Type": "application/octet-stream" };
    const path = `/api/upload?name=${encodeURIComponent(name)}`;
    return (await (await ask(path, { method: "POST", headers, body: file })).json()).file;
}

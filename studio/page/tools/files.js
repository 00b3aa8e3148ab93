// What was written into the project's folder `out`.

import { h, replace } from "../dom/element.js";
import { t } from "../words/words.js";
import { store, watch, whenChanged } from "../server/store.js";

const size = (bytes) =>
    bytes < 1e3
        ? `${bytes} B`
        : bytes < 1e6
          ? `${(bytes / 1e3).toFixed(0)} kB`
          : `${(bytes / 1e6).toFixed(1)} MB`;
const address = (path) => `/api/out/${path.split("/").map(encodeURIComponent).join("/")}`;
const picture = /\.(png|jpe?g|svg)$/i;

export function mountFiles(root) {
    const part = h("div");
    replace(root, h("div", { class: "bar" }, h("h2", { word: "tab.files" })), part);
    const draw = whenChanged((files, folder) =>
        replace(
            part,
            files.length === 0
                ? h("p", { class: "hint", word: "files.none" })
                : [
                      h("p", { class: "hint" }, t("files.where", { folder: `${folder}/out` })),
                      h(
                          "ul",
                          { class: "files" },
                          files.map(({ path, bytes }) =>
                              h(
                                  "li",
                                  {},
                                  h("a", { href: address(path), target: "_blank", rel: "noopener" }, path),
                                  h("span", { class: "hint" }, ` ${size(bytes)}`),
                                  picture.test(path) &&
                                      h("img", {
                                          src: `${address(path)}?b=${bytes}`,
                                          alt: "",
                                          loading: "lazy",
                                      }),
                              ),
                          ),
                      ),
                  ],
        ),
    );
    watch(["files", "state"], () => draw(store.files, store.state?.project.folder));
}

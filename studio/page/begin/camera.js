// A photo by the camera of this machine, for those who have the garment before them.

import { h, replace } from "../dom/element.js";
import { t } from "../words/words.js";
import { sayWord } from "../head/status.js";

/** What is asked of the camera; one with fewer pixels gives what it has. */
const WANTED = { video: { facingMode: "environment", width: { ideal: 3840 }, height: { ideal: 2160 } } };
const QUALITY = 0.95;

export const hasCamera = () => Boolean(navigator.mediaDevices?.getUserMedia);

/** Shows what the camera sees; `take(file)` gets the photo, `back()` is for who takes none. */
export async function shoot(root, take, back) {
    let stream;
    try {
        stream = await navigator.mediaDevices.getUserMedia(WANTED);
    } catch (error) {
        sayWord("begin.noCamera", { why: error.message }, "error");
        return;
    }
    const end = () => stream.getTracks().forEach((track) => track.stop());
    const video = h("video", { autoplay: true, playsinline: true, "aria-label": t("begin.camera") });
    video.muted = true;
    video.srcObject = stream;
    const button = h("button", { class: "primary", word: "begin.shoot", disabled: true });
    video.addEventListener("playing", () => {
        button.disabled = false;
        button.focus();
    });
    button.addEventListener("click", () => {
        const canvas = h("canvas", { width: video.videoWidth, height: video.videoHeight });
        canvas.getContext("2d").drawImage(video, 0, 0);
        end();
        canvas.toBlob((blob) => take(new File([blob], "photo.jpg", { type: blob.type })), "image/jpeg", QUALITY);
    });
    replace(
        root,
        h(
            "div",
            { class: "card two" },
            video,
            h(
                "div",
                { class: "ask" },
                h("h2", { word: "begin.camera" }),
                h("p", { class: "hint", word: "begin.cameraHow" }),
                h(
                    "p",
                    { class: "line" },
                    button,
                    h("button", {
                        word: "begin.back",
                        onclick: () => {
                            end();
                            back();
                        },
                    }),
                ),
            ),
        ),
    );
}

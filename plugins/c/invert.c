/* A plugin in plain C: turns dark into light, for garments that are darker than their ground.
 *
 *     cc -std=c11 -O2 -shared -fPIC -I core/include -o libinvert.so plugins/c/invert.c
 *     toile run pipeline.ron --plugin ./libinvert.so        (with InvertC() among its stages)
 */
#include "toile_plugin.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TEXT(s) {s, sizeof(s) - 1}

typedef struct {
    long white;
} invert;

static toile_text text_of(const char *s) {
    toile_text t = {s, strlen(s)};
    return t;
}

static int32_t fail(const toile_host *host, const char *code, const char *message, const char *about) {
    host->fail(host->ctx, text_of(code), text_of(message), text_of(""), text_of(about));
    return TOILE_FAILED;
}

/* The arguments are RON: `(white: 200)` or `()`. The program has checked names and ranges. */
static int32_t create(toile_text arguments, const toile_host *host, void **stage) {
    char text[256];
    if (arguments.len >= sizeof text) return fail(host, "invalid_parameter", "the arguments are too long", "");
    memcpy(text, arguments.ptr, arguments.len);
    text[arguments.len] = 0;
    invert *made = malloc(sizeof *made);
    if (!made) return fail(host, "internal", "there is no memory", "");
    made->white = 255;
    const char *given = strstr(text, "white");
    if (given && sscanf(given, "white : %ld", &made->white) != 1) sscanf(given, "white: %ld", &made->white);
    *stage = made;
    return TOILE_OK;
}

static int32_t describe(const void *stage, const toile_host *host) {
    char text[64];
    snprintf(text, sizeof text, "(white: %ld)", ((const invert *)stage)->white);
    host->answer(host->ctx, text_of(text));
    return TOILE_OK;
}

static const toile_field *field(const toile_record *record, const char *name) {
    for (size_t i = 0; i < record->count; i++) {
        const toile_field *f = &record->fields[i];
        if (f->name.len == strlen(name) && memcmp(f->name.ptr, name, f->name.len) == 0) return f;
    }
    return NULL;
}

/* Rows are inverted on the program's threads where it offers them. */
typedef struct {
    const uint8_t *from;
    uint8_t *to;
    size_t row;
    long white;
} rows;

static void invert_row(void *data, size_t y) {
    const rows *r = data;
    for (size_t i = y * r->row; i < (y + 1) * r->row; i++) {
        long level = r->white - r->from[i];
        r->to[i] = (uint8_t)(level < 0 ? 0 : level);
    }
}

static void for_rows(const toile_host *host, size_t count, rows *r) {
#if TOILE_ABI_MINOR >= 1
    host->parallel_for(host->ctx, count, r, invert_row);
#else
    for (size_t y = 0; y < count && !host->cancelled(host->ctx); y++) invert_row(r, y);
#endif
}

static int32_t run(const void *stage, const toile_host *host, const toile_call *call) {
    const toile_record *photo = call->inputs[0].record;
    const toile_field *pixels = field(photo, "pixels"), *size = field(photo, "size");
    if (!pixels || !size || pixels->kind != TOILE_FIELD_U8 || size->kind != TOILE_FIELD_U32 || size->count != 2)
        return fail(host, "invalid_input", "the photo has no pixels", "");
    size_t height = ((const uint32_t *)size->data)[1];
    uint8_t *out = host->alloc(host->ctx, pixels->count);
    if (!out) return TOILE_FAILED;
    rows r = {pixels->data, out, height ? pixels->count / height : 0, ((const invert *)stage)->white};
    for_rows(host, height, &r);

    /* The same photo with other pixels: all other fields are passed on as they are. */
    toile_field *fields = malloc(photo->count * sizeof *fields);
    if (!fields) return fail(host, "internal", "there is no memory", "");
    memcpy(fields, photo->fields, photo->count * sizeof *fields);
    fields[pixels - photo->fields].data = out;
    fields[pixels - photo->fields].owner = NULL; /* memory of alloc: the program takes it as it is */
    toile_record made = {fields, photo->count};
    host->figure(host->ctx, text_of("white"), (double)((const invert *)stage)->white, text_of("grey levels"));
    toile_text whole = {NULL, 0};
    int32_t status = host->give(host->ctx, 0, whole, &made);
    free(fields);
    return status;
}

static void destroy(void *stage) { free(stage); }

static toile_param params[] = {{TEXT("white"), TEXT("The level that becomes black."), TEXT("whole number"),
                                TEXT("grey levels"), TEXT("255"), 1.0, 255.0, 0, 0}};
static const toile_port inputs[] = {{TEXT("photo"), TEXT("photo"), TOILE_ARITY_EACH, 0}};
static const toile_port outputs[] = {{{NULL, 0}, TEXT("photo"), TOILE_ARITY_ONE, 0}};
static const toile_text contracts[] = {TEXT("deterministic"), TEXT("thread_invariant")};

static const toile_stage_table table = {
    .version = 1,
    .name = TEXT("InvertC"),
    .role = TEXT("denoiser"),
    .doc = TEXT("Turns dark into light, for garments that are darker than their ground."),
    .source = TEXT("none"),
    .example = TEXT("InvertC(white: 200)"),
    .contracts = contracts,
    .contract_count = 2,
    .params = params,
    .param_count = 1,
    .inputs = inputs,
    .input_count = 1,
    .outputs = outputs,
    .output_count = 1,
    .create = create,
    .describe = describe,
    .run = run,
    .destroy = destroy,
};

static const void *stages(size_t *count) {
    *count = 1;
    return &table;
}

TOILE_EXPORT const toile_declaration toile_plugin_invert = {
    .magic = TOILE_MAGIC,
    .major = TOILE_ABI_MAJOR,
    .minor = TOILE_ABI_MINOR,
    .size = sizeof(toile_declaration),
    .stage_size = sizeof(toile_stage_table),
    .param_size = sizeof(toile_param),
    .port_size = sizeof(toile_port),
    .name = TEXT("invert"),
    .version = TEXT("0.1.0"),
    .stages = stages,
};

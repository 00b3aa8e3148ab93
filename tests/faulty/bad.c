/* A plugin that is wrong in one way, chosen by -DCASE_...; without a case it is right. */
#include "toile_plugin.h"

#include <math.h>
#include <stdlib.h>

#define TEXT(s) {s, sizeof(s) - 1}
#define NONE {NULL, 0}

static int stage_object;

#ifdef CASE_EXITS_ON_LOAD
__attribute__((constructor)) static void on_load(void) { exit(0); }
#endif

__attribute__((unused)) static void spin(void) {
    for (volatile int turns = 0;; turns = 1 - turns) {
    }
}

__attribute__((unused)) static void ends(void *data, size_t i) {
    (void)data;
    if (i == 3) exit(0);
}

#if defined(CASE_LACKS_FUNCTION) || defined(CASE_LACKS_LIBRARY)
int toile_helper(void);
#endif

static int32_t create(toile_text arguments, const toile_host *host, void **stage) {
    (void)arguments, (void)host;
#if defined(CASE_EXITS_IN_CREATE)
    exit(0);
#elif defined(CASE_SPINS_IN_CREATE)
    spin();
#endif
    *stage = &stage_object;
    return TOILE_OK;
}

static void destroy(void *stage) { (void)stage; }

__attribute__((unused)) static int32_t run(const void *stage, const toile_host *host, const toile_call *call) {
    (void)stage;
    toile_text whole = NONE;
    const toile_record *photo = call->inputs[0].record;
    (void)photo;
#if defined(CASE_CLAIMS_ALLOC)
    if (!host->alloc(host->ctx, (size_t)1 << 50)) return TOILE_FAILED;
#elif defined(CASE_CLAIMS_RECORD)
    toile_field claims[] = {{TEXT("pixels"), &stage_object, (size_t)1 << 50, TOILE_FIELD_U8, 3, NULL}};
    toile_record record = {claims, 1};
    return host->give(host->ctx, 0, whole, &record);
#elif defined(CASE_NULL_DATA)
    toile_field empty[] = {{TEXT("pixels"), NULL, 12, TOILE_FIELD_U8, 3, NULL}};
    toile_record record = {empty, 1};
    return host->give(host->ctx, 0, whole, &record);
#elif defined(CASE_NO_FIELDS)
    toile_record record = {NULL, 0};
    return host->give(host->ctx, 0, whole, &record);
#elif defined(CASE_UNKNOWN_STATUS)
    return 77;
#elif defined(CASE_SILENT)
    return TOILE_FAILED;
#elif defined(CASE_TWICE)
    host->give(host->ctx, 0, whole, photo);
    host->give(host->ctx, 0, whole, photo);
    return TOILE_OK;
#elif defined(CASE_OTHER_PORT)
    return host->give(host->ctx, 3, whole, photo);
#elif defined(CASE_NO_OUTPUT)
    return TOILE_OK;
#elif defined(CASE_EXITS)
    exit(0);
#elif defined(CASE_QUICK_EXITS)
    quick_exit(0);
#elif defined(CASE_EXITS_IN_LOOP)
    host->parallel_for(host->ctx, 8, NULL, ends);
#elif defined(CASE_SPINS)
    spin();
#elif defined(CASE_LACKS_FUNCTION) || defined(CASE_LACKS_LIBRARY)
    if (toile_helper()) return TOILE_FAILED;
#endif
    return host->give(host->ctx, 0, whole, photo);
}

static const toile_port inputs[] = {{TEXT("photo"), TEXT("photo"), TOILE_ARITY_EACH, 0}};
static const toile_port outputs[] = {{NONE,
#ifdef CASE_UNKNOWN_KIND
                                      TEXT("hologram"),
#else
                                      TEXT("photo"),
#endif
                                      TOILE_ARITY_ONE, 0}};

#ifdef CASE_FINER_BOTH_WAYS
static const toile_param params[] = {{TEXT("cell"), TEXT("A cell."), TEXT("number"), NONE, TEXT("1.0"), 0.0, 9.0,
                                      TOILE_PARAM_TRADES | TOILE_PARAM_FINER_LESS | TOILE_PARAM_FINER_MORE, 0}};
#endif

static const toile_stage_table table = {
    .version = 1,
#if defined(CASE_TAKEN_NAME)
    .name = TEXT("Otsu"),
#elif defined(CASE_NO_NAME)
    .name = TEXT("no name"),
#elif defined(CASE_NOT_UTF8)
    .name = TEXT("\xff\xfe"),
#else
    .name = TEXT("Passes"),
#endif
#ifdef CASE_UNKNOWN_ROLE
    .role = TEXT("ironer"),
#else
    .role = TEXT("denoiser"),
#endif
    .doc = TEXT("Passes photos on."),
    .inputs = inputs,
    .input_count = 1,
    .outputs = outputs,
    .output_count = 1,
#ifdef CASE_FINER_BOTH_WAYS
    .params = params,
    .param_count = 1,
#endif
    .create = create,
#ifndef CASE_NULL_RUN
    .run = run,
#endif
    .destroy = destroy,
};

__attribute__((unused)) static const void *stages(size_t *count) {
#ifdef CASE_NO_STAGES
    *count = 0;
#else
    *count = 1;
#endif
    return &table;
}

TOILE_EXPORT const toile_declaration
#ifdef CASE_NO_SYMBOL
    something_else
#else
    toile_plugin
#endif
    = {
#ifdef CASE_WRONG_MAGIC
        .magic = {'N', 'O', 'T', 'T', 'O', 'I', 'L', 'E'},
#else
        .magic = TOILE_MAGIC,
#endif
#ifdef CASE_NEWER_MAJOR
        .major = 2,
#else
        .major = TOILE_ABI_MAJOR,
#endif
#ifdef CASE_NEWER_MINOR
        .minor = 9,
#else
        .minor = TOILE_ABI_MINOR,
#endif
#ifdef CASE_SHORT_DECLARATION
        .size = 40,
#else
        .size = sizeof(toile_declaration),
#endif
#ifdef CASE_SHORT_TABLES
        .stage_size = 64,
#else
        .stage_size = sizeof(toile_stage_table),
#endif
        .param_size = sizeof(toile_param),
        .port_size = sizeof(toile_port),
        .name = TEXT("bad"),
        .version = TEXT("1.2.3"),
#ifndef CASE_NULL_STAGES
        .stages = stages,
#endif
};

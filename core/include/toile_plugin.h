/* The ABI between Toile and its plugins: C form of core/src/plugin/abi.rs.
 *
 * docs/reference/plugin-abi.md is the specification. In short: fields are only added at the end of a structure, with a new
 * minor version; who passes memory keeps it until the call returns; nobody frees what the other side made.
 *
 * Define TOILE_ABI_MINOR as 0 before including this file to build a plugin for older programs. */
#ifndef TOILE_PLUGIN_H
#define TOILE_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TOILE_ABI_MAJOR 1
#ifndef TOILE_ABI_MINOR
#define TOILE_ABI_MINOR 2
#endif

#define TOILE_MAGIC {'T', 'O', 'I', 'L', 'E', 'P', 'L', 'G'}

/* What a call gives back. */
#define TOILE_OK 0
#define TOILE_FAILED 1   /* gave the reason through host->fail */
#define TOILE_PANICKED 2 /* the same, of an exception or panic that ended at the ABI */

/* UTF-8, not ended by a zero; ptr may be null where len is 0. */
typedef struct toile_text {
    const char *ptr;
    size_t len;
} toile_text;

/* ---- artifacts: records of named fields -------------------------------------------------------- */

#define TOILE_FIELD_U8 1
#define TOILE_FIELD_U32 2
#define TOILE_FIELD_U64 3
#define TOILE_FIELD_F32 4
#define TOILE_FIELD_F64 5
#define TOILE_FIELD_TEXT 6
#define TOILE_FIELD_RECORDS 7 /* data points at toile_record[count] */

/* Keeps a list beyond the call that lent it. */
typedef struct toile_owner {
    void *ctx;
    void *(*retain)(void *ctx);    /* a handle that keeps the list, unchanged, until release */
    void (*release)(void *handle); /* from any thread */
} toile_owner;

typedef struct toile_field {
    toile_text name;
    const void *data;
    size_t count;   /* numbers, bytes of text, or records */
    uint32_t kind;  /* TOILE_FIELD_... */
    uint32_t width; /* numbers in one element: 3 for points in space */
    const toile_owner *owner; /* null: the list must be copied before the call returns */
} toile_field;

typedef struct toile_record {
    const toile_field *fields;
    size_t count;
} toile_record;

/* ---- a stage's card ---------------------------------------------------------------------------- */

#define TOILE_ARITY_ONE 0  /* a single value */
#define TOILE_ARITY_EACH 1 /* one value of a named set at a time */
#define TOILE_ARITY_ALL 2  /* the whole named set */

#define TOILE_PORT_OPTIONAL 1
#define TOILE_PORT_ORIGINAL 2 /* the first made of its kind: the photo as read */

typedef struct toile_port {
    toile_text name; /* empty for an output */
    toile_text kind; /* photo, mask, outline, panel, body, collider, garment, model, ... */
    uint32_t arity;
    uint32_t flags;
} toile_port;

#define TOILE_PARAM_TRADES 1 /* trades accuracy for time */
#define TOILE_PARAM_FINER_LESS 2 /* a resolution, less is finer: an edge length, a time step */
#define TOILE_PARAM_FINER_MORE 4 /* a resolution, more is finer: a count of iterations */
#define TOILE_PARAM_WAY 8 /* different work if the value is not the default: its cost is recorded separately */

typedef struct toile_param {
    toile_text name;
    toile_text doc;
    toile_text kind; /* number, whole number, length, true | false, text, ... */
    toile_text unit;
    toile_text default_value; /* as RON */
    double min;               /* lengths in metres; NAN where there is none */
    double max;
    uint32_t flags;
    uint32_t reserved;
} toile_param;

/* ---- colliders --------------------------------------------------------------------------------- */

typedef struct toile_body_contact {
    uint32_t vertex;
    double point[3];
    double normal[3]; /* outward, of length 1 */
    double distance;  /* metres, negative inside */
} toile_body_contact;

typedef struct toile_self_contact {
    uint32_t vertices[4];
    double weights[4]; /* sum to zero */
    double normal[3];
    double distance;
} toile_self_contact;

/* A list of results in the asker's memory: room for so many more, to be filled before the next call. */
typedef struct toile_sink {
    void *ctx;
    void *(*grow)(void *ctx, size_t count);
} toile_sink;

typedef struct toile_cloth {
    const double *positions; /* three a point, metres */
    size_t points;
    const uint32_t *triangles; /* three a triangle; null where none are asked about */
    size_t triangle_count;
} toile_cloth;

typedef struct toile_collider_card {
    double thickness; /* metres */
    double friction;
    double restitution;
    double penalty; /* coefficient of the force that pushes cloth off the body; NAN where contacts are resolved by impulses */
    uint32_t self_collision;
    uint32_t penalty_law; /* 0: N/m times how much nearer than the thickness cloth is; 1: N times exp(-distance / thickness) */
} toile_collider_card;

struct toile_collider;

/* Called in the solvers' inner loops, from several threads at once. */
typedef struct toile_collider_table {
    uint32_t size;
    uint32_t reserved;
    int32_t (*card)(const void *self, toile_collider_card *card);
    int32_t (*body_contacts)(const void *self, const toile_cloth *cloth, double reach, const toile_sink *sink);
    int32_t (*body_hits)(const void *self, const toile_cloth *from, const toile_cloth *to, const toile_sink *sink);
    int32_t (*self_contacts)(const void *self, const toile_cloth *cloth, double reach, const toile_sink *sink);
    int32_t (*conservative_bounds)(const void *self, const toile_cloth *cloth, double reach, double *bounds);
    int32_t (*self_crossings)(const void *self, const toile_cloth *cloth, const toile_sink *sink); /* uint32_t[2] */
    int32_t (*share)(const void *self, struct toile_collider *collider); /* may be null in a plugin's own */
    toile_text (*why)(const void *self);                                 /* may be null */
    void (*destroy)(void *self);
} toile_collider_table;

typedef struct toile_collider {
    const toile_collider_table *table;
    void *self;
    toile_text signature; /* names scheme and settings */
} toile_collider;

/* ---- a run ------------------------------------------------------------------------------------- */

typedef struct toile_input {
    uint32_t port;
    uint32_t reserved;
    toile_text kind;
    toile_text name;                /* in a named set; empty for a single value */
    const toile_record *record;     /* null for a service */
    const toile_collider *collider; /* null for an artifact */
} toile_input;

#define TOILE_FED_NOTHING 0
#define TOILE_FED_ONE 1
#define TOILE_FED_SET 2

typedef struct toile_call {
    uint32_t size;
    uint32_t ports;
    const uint32_t *fed; /* TOILE_FED_..., one a port */
    const toile_input *inputs;
    size_t count;
    toile_text stage; /* its id in the pipeline */
    toile_text entry; /* of the named set at work; may be empty */
    toile_text base;  /* folder that paths are relative to */
} toile_call;

/* Callable from any thread until the call returns. */
typedef struct toile_host {
    uint32_t size;
    uint32_t major;
    uint32_t minor;
    uint32_t threads;
    void *ctx;
    void *(*alloc)(void *ctx, size_t bytes); /* zeroed, freed by the program after the call; null: give back FAILED */
    int32_t (*give)(void *ctx, uint32_t port, toile_text name, const toile_record *record);
    int32_t (*give_collider)(void *ctx, uint32_t port, const toile_collider *collider);
    void (*answer)(void *ctx, toile_text text);
    void (*fail)(void *ctx, toile_text code, toile_text message, toile_text hint, toile_text about);
    void (*warn)(void *ctx, toile_text text);
    void (*progress)(void *ctx, double share, toile_text text);
    void (*figure)(void *ctx, toile_text name, double value, toile_text unit);
    uint8_t (*cancelled)(void *ctx); /* ask at least every 50 ms */
#if TOILE_ABI_MINOR >= 1
    void (*parallel_for)(void *ctx, size_t count, void *data, void (*body)(void *data, size_t index));
    /* A file was read: run again when it changes. digest: BLAKE3 of its content, 32 bytes, or null. */
    void (*reads)(void *ctx, toile_text path, const uint8_t *digest);
#endif
#if TOILE_ABI_MINOR >= 2
    void (*note)(void *ctx, toile_text text); /* what was decided; warn: what the user should look at */
#endif
} toile_host;

typedef struct toile_stage_table {
    uint32_t version; /* of the algorithm */
    uint32_t reserved;
    toile_text name;
    toile_text role;
    toile_text doc;
    toile_text source;
    toile_text example;
    const toile_text *contracts;
    size_t contract_count;
    const toile_param *params;
    size_t param_count;
    const toile_port *inputs;
    size_t input_count;
    const toile_port *outputs;
    size_t output_count;
    int32_t (*create)(toile_text arguments, const toile_host *host, void **stage);
    int32_t (*describe)(const void *stage, const toile_host *host); /* answers its parameters as RON */
    int32_t (*run)(const void *stage, const toile_host *host, const toile_call *call);
    void (*destroy)(void *stage);
#if TOILE_ABI_MINOR >= 1
    /* Checks a RON text as the value of a parameter; may be null. offset: the byte at fault, or -1. */
    int32_t (*check)(size_t param, toile_text text, const toile_host *host, int64_t *offset);
#endif
} toile_stage_table;

/* Exported as `toile_plugin`, or as `toile_plugin_` and a name of its own. */
typedef struct toile_declaration {
    uint8_t magic[8];
    uint32_t major;
    uint32_t minor;
    uint32_t size;
    uint32_t stage_size;
    uint32_t param_size;
    uint32_t port_size;
    toile_text name;
    toile_text version;
    const void *(*stages)(size_t *count);
} toile_declaration;

#if defined(_WIN32)
#define TOILE_EXPORT __declspec(dllexport)
#else
#define TOILE_EXPORT __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
}
#endif

#endif

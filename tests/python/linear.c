/* A co-simulation unit of FMI 2.0 that is none of impinge's: two linear equations,
 *     x' = A x + b u(t),   y = c x + d u + e,   z = f x,
 * by the classical method of Runge and Kutta in SUBSTEPS parts of a step. Inputs may be quadratics in
 * time. References: 0 u, 1 y, 2 z, 3 to 6 A, 7 8 b, 9 10 c, 11 d, 12 e, 13 14 f, 15 16 x at first. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SUBSTEPS = 64, VALUES = 17, OK = 0, DISCARD = 2, ERROR = 3 };
typedef struct {
    double value[VALUES]; /* of parameters; [0] is the input */
    double rate[2];       /* derivatives of the input */
    double x[2], time;
} State;
typedef struct { double start[VALUES]; State state; } Instance;

static void slope(const State *s, const double x[2], double t, double out[2]) {
    const double *v = s->value, u = v[0] + t * (s->rate[0] + t * s->rate[1] / 2);
    out[0] = v[3] * x[0] + v[4] * x[1] + v[7] * u;
    out[1] = v[5] * x[0] + v[6] * x[1] + v[8] * u;
}

static void advance(State *s, double size) {
    double h = size / SUBSTEPS, k[4][2], y[2];
    for (int n = 0; n < SUBSTEPS; n++) {
        double t = n * h;
        slope(s, s->x, t, k[0]);
        for (int i = 0; i < 2; i++) y[i] = s->x[i] + h / 2 * k[0][i];
        slope(s, y, t + h / 2, k[1]);
        for (int i = 0; i < 2; i++) y[i] = s->x[i] + h / 2 * k[1][i];
        slope(s, y, t + h / 2, k[2]);
        for (int i = 0; i < 2; i++) y[i] = s->x[i] + h * k[2][i];
        slope(s, y, t + h, k[3]);
        for (int i = 0; i < 2; i++)
            s->x[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    }
    s->value[0] += size * (s->rate[0] + size * s->rate[1] / 2);
    s->rate[0] = s->rate[1] = 0;
    s->time += size;
}

static double read(const State *s, unsigned reference) {
    const double *v = s->value;
    if (reference == 1) return v[9] * s->x[0] + v[10] * s->x[1] + v[11] * v[0] + v[12];
    if (reference == 2) return v[13] * s->x[0] + v[14] * s->x[1];
    return v[reference];
}

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }
void *fmi2Instantiate(const char *n, int t, const char *g, const char *r, const void *c, int v, int l) {
    (void)n, (void)t, (void)g, (void)c, (void)v, (void)l;
    char path[4096];
    Instance *made = calloc(1, sizeof(Instance));
    snprintf(path, sizeof path, "%s/start.txt", r + strlen("file://"));
    FILE *file = fopen(path, "r");
    for (int i = 0; made && file && i < VALUES; i++)
        if (fscanf(file, "%lf", &made->start[i]) != 1) return NULL;
    if (!made || !file) return NULL;
    fclose(file);
    memcpy(made->state.value, made->start, sizeof made->start);
    return made;
}
void fmi2FreeInstance(void *c) { free(c); }
int fmi2SetDebugLogging(void *c, int on, size_t n, const char *const names[]) {
    return (void)c, (void)on, (void)n, (void)names, OK;
}
int fmi2SetupExperiment(void *c, int td, double t, double start, int sd, double stop) {
    return (void)td, (void)t, (void)sd, (void)stop, ((Instance *)c)->state.time = start, OK;
}
int fmi2EnterInitializationMode(void *c) { return (void)c, OK; }
int fmi2ExitInitializationMode(void *c) {
    State *s = &((Instance *)c)->state;
    return memcpy(s->x, s->value + 15, sizeof s->x), OK;
}
int fmi2Terminate(void *c) { return (void)c, OK; }
int fmi2Reset(void *c) {
    Instance *i = c;
    memset(&i->state, 0, sizeof i->state);
    return memcpy(i->state.value, i->start, sizeof i->start), OK;
}

#define NONE(NAME, TYPE) \
    int fmi2Get##NAME(void *c, const unsigned *r, size_t n, TYPE *v) { return (void)c, (void)r, (void)v, n ? ERROR : OK; } \
    int fmi2Set##NAME(void *c, const unsigned *r, size_t n, const TYPE *v) { return (void)c, (void)r, (void)v, n ? ERROR : OK; }
NONE(Integer, int)
NONE(Boolean, int)
NONE(String, const char *)

int fmi2GetReal(void *c, const unsigned *r, size_t n, double *v) {
    for (size_t i = 0; i < n; i++) {
        if (r[i] >= VALUES) return ERROR;
        v[i] = read(&((Instance *)c)->state, r[i]);
    }
    return OK;
}
int fmi2SetReal(void *c, const unsigned *r, size_t n, const double *v) {
    for (size_t i = 0; i < n; i++) {
        if (r[i] >= VALUES || r[i] == 1 || r[i] == 2) return ERROR;
        ((Instance *)c)->state.value[r[i]] = v[i];
    }
    return OK;
}
int fmi2SetRealInputDerivatives(void *c, const unsigned *r, size_t n, const int *order, const double *v) {
    for (size_t i = 0; i < n; i++) {
        if (r[i] || order[i] < 1 || order[i] > 2) return ERROR;
        ((Instance *)c)->state.rate[order[i] - 1] = v[i];
    }
    return OK;
}
int fmi2GetRealOutputDerivatives(void *c, const unsigned *r, size_t n, const int *order, double *v) {
    return (void)c, (void)r, (void)n, (void)order, (void)v, ERROR;
}
int fmi2DoStep(void *c, double point, double size, int past) {
    State *s = &((Instance *)c)->state;
    (void)past;
    if (size <= 0 || point > s->time + 1e-9 * size || point < s->time - 1e-9 * size) return ERROR;
    return advance(s, size), OK;
}
int fmi2CancelStep(void *c) { return (void)c, ERROR; }
int fmi2GetStatus(void *c, int k, int *v) { return (void)c, (void)k, (void)v, DISCARD; }
int fmi2GetIntegerStatus(void *c, int k, int *v) { return (void)c, (void)k, (void)v, DISCARD; }
int fmi2GetBooleanStatus(void *c, int k, int *v) { return (void)c, (void)k, (void)v, DISCARD; }
int fmi2GetStringStatus(void *c, int k, const char **v) { return (void)c, (void)k, (void)v, DISCARD; }
int fmi2GetRealStatus(void *c, int k, double *v) {
    return (void)k, *v = ((Instance *)c)->state.time, OK;
}
int fmi2GetFMUstate(void *c, void **s) {
    if (!*s) *s = malloc(sizeof(State));
    return memcpy(*s, &((Instance *)c)->state, sizeof(State)), OK;
}
int fmi2SetFMUstate(void *c, void *s) { return memcpy(&((Instance *)c)->state, s, sizeof(State)), OK; }
int fmi2FreeFMUstate(void *c, void **s) { return (void)c, free(*s), *s = NULL, OK; }
int fmi2SerializedFMUstateSize(void *c, void *s, size_t *n) { return (void)c, (void)s, *n = sizeof(State), OK; }
int fmi2SerializeFMUstate(void *c, void *s, char b[], size_t n) { return (void)c, memcpy(b, s, n), OK; }
int fmi2DeSerializeFMUstate(void *c, const char b[], size_t n, void **s) {
    if (n != sizeof(State)) return ERROR;
    if (!*s) *s = malloc(sizeof(State));
    return (void)c, memcpy(*s, b, n), OK;
}
int fmi2GetDirectionalDerivative(void *c, const unsigned *u, size_t nu, const unsigned *k, size_t nk, const double *dk, double *du) {
    return (void)c, (void)u, (void)nu, (void)k, (void)nk, (void)dk, (void)du, ERROR;
}

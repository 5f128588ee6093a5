/* A co-simulation unit of FMI 2.0 that is none of impinge's: linear equations with one input u,
 *     x' = A x + b u(t),   y = c x + d u + e,   z = Δ(f x + g u) / Δt over the last step,
 * exact in time for inputs that are quadratics over a step: the exponential of
 *     [A b 0 0; 0 0 1 0; 0 0 0 1; 0 0 0 0] Δt  acts on  (x, u, u', u'').
 * resources/start.txt holds n, A (by rows), b, c, d, e, f, g, u and x at first.
 * References: 0 u, 1 y, 2 z. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 64, SIZE = MOST + 3, OK = 0, DISCARD = 2, ERROR = 3 };
typedef struct { double x[SIZE], z, time; } State; /* x, then the input and its derivatives */
typedef struct {
    int n;
    double a[MOST][MOST], b[MOST], c[MOST], d, e, f[MOST], g, u, first[MOST];
    double step, power[SIZE][SIZE]; /* the exponential for the last length of a step */
    State state;
} Unit;

static void multiply(int n, double a[SIZE][SIZE], double b[SIZE][SIZE], double out[SIZE][SIZE]) {
    static _Thread_local double sum[SIZE][SIZE];
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            sum[i][j] = 0;
            for (int k = 0; k < n; k++) sum[i][j] += a[i][k] * b[k][j];
        }
    memcpy(out, sum, sizeof sum);
}

/* Taylor's series to order 14 of a matrix whose norm halvings have brought below a quarter. */
static void exponential(Unit *u, double size) {
    static _Thread_local double m[SIZE][SIZE], term[SIZE][SIZE];
    int n = u->n, all = n + 3, halvings = 0;
    double norm = 0;
    memset(m, 0, sizeof m);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) m[i][j] = u->a[i][j] * size;
        m[i][n] = u->b[i] * size;
    }
    m[n][n + 1] = m[n + 1][n + 2] = size;
    for (int i = 0; i < all; i++) {
        double row = 0;
        for (int j = 0; j < all; j++) row += fabs(m[i][j]);
        norm = fmax(norm, row);
    }
    for (; norm > 0.25; norm /= 2) halvings++;
    for (int i = 0; i < all; i++)
        for (int j = 0; j < all; j++) m[i][j] = ldexp(m[i][j], -halvings);
    memset(u->power, 0, sizeof u->power);
    memset(term, 0, sizeof term);
    for (int i = 0; i < all; i++) u->power[i][i] = term[i][i] = 1;
    for (int k = 1; k <= 14; k++) {
        multiply(all, term, m, term);
        for (int i = 0; i < all; i++)
            for (int j = 0; j < all; j++) u->power[i][j] += term[i][j] /= k;
    }
    while (halvings--) multiply(all, u->power, u->power, u->power);
    u->step = size;
}

static double held(const Unit *u) {
    double sum = u->g * u->state.x[u->n];
    for (int i = 0; i < u->n; i++) sum += u->f[i] * u->state.x[i];
    return sum;
}

static double output(const Unit *u) {
    double sum = u->d * u->state.x[u->n] + u->e;
    for (int i = 0; i < u->n; i++) sum += u->c[i] * u->state.x[i];
    return sum;
}

static void restart(Unit *u) {
    memset(&u->state, 0, sizeof u->state);
    memcpy(u->state.x, u->first, u->n * sizeof(double));
    u->state.x[u->n] = u->u;
}

static int scan(FILE *file, double *to, int count) {
    for (int i = 0; i < count; i++)
        if (fscanf(file, "%lf", to + i) != 1) return 0;
    return 1;
}

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }
void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources,
                      const void *callbacks, int visible, int logging) {
    (void)name, (void)type, (void)guid, (void)callbacks, (void)visible, (void)logging;
    char path[4096];
    Unit *u = calloc(1, sizeof(Unit));
    snprintf(path, sizeof path, "%s/start.txt", resources + strlen("file://"));
    FILE *file = fopen(path, "r");
    if (!u || !file || fscanf(file, "%d", &u->n) != 1 || u->n > MOST) return NULL;
    int good = 1, n = u->n;
    for (int i = 0; i < n; i++) good &= scan(file, u->a[i], n);
    good &= scan(file, u->b, n) & scan(file, u->c, n) & scan(file, &u->d, 1) & scan(file, &u->e, 1);
    good &= scan(file, u->f, n) & scan(file, &u->g, 1) & scan(file, &u->u, 1) & scan(file, u->first, n);
    fclose(file);
    restart(u);
    return good ? u : NULL;
}
void fmi2FreeInstance(void *c) { free(c); }
int fmi2SetDebugLogging(void *c, int on, size_t n, const char *const names[]) {
    return (void)c, (void)on, (void)n, (void)names, OK;
}
int fmi2SetupExperiment(void *c, int given, double t, double start, int ends, double stop) {
    return (void)given, (void)t, (void)ends, (void)stop, ((Unit *)c)->state.time = start, OK;
}
int fmi2EnterInitializationMode(void *c) { return (void)c, OK; }
int fmi2ExitInitializationMode(void *c) { return (void)c, OK; }
int fmi2Terminate(void *c) { return (void)c, OK; }
int fmi2Reset(void *c) { return restart(c), OK; }

#define NONE(NAME, TYPE)                                                                           \
    int fmi2Get##NAME(void *c, const unsigned *r, size_t n, TYPE *v) {                             \
        return (void)c, (void)r, (void)v, n ? ERROR : OK;                                          \
    }                                                                                              \
    int fmi2Set##NAME(void *c, const unsigned *r, size_t n, const TYPE *v) {                       \
        return (void)c, (void)r, (void)v, n ? ERROR : OK;                                          \
    }
NONE(Integer, int)
NONE(Boolean, int)
NONE(String, const char *)

int fmi2GetReal(void *c, const unsigned *r, size_t n, double *v) {
    const Unit *u = c;
    for (size_t i = 0; i < n; i++) {
        if (r[i] > 2) return ERROR;
        v[i] = r[i] == 0 ? u->state.x[u->n] : r[i] == 1 ? output(u) : u->state.z;
    }
    return OK;
}
int fmi2SetReal(void *c, const unsigned *r, size_t n, const double *v) {
    Unit *u = c;
    for (size_t i = 0; i < n; i++) {
        if (r[i]) return ERROR;
        u->state.x[u->n] = v[i];
    }
    return OK;
}
int fmi2SetRealInputDerivatives(void *c, const unsigned *r, size_t n, const int *o, const double *v) {
    Unit *u = c;
    for (size_t i = 0; i < n; i++) {
        if (r[i] || o[i] < 1 || o[i] > 2) return ERROR;
        u->state.x[u->n + o[i]] = v[i];
    }
    return OK;
}
int fmi2GetRealOutputDerivatives(void *c, const unsigned *r, size_t n, const int *o, double *v) {
    return (void)c, (void)r, (void)n, (void)o, (void)v, ERROR;
}
int fmi2DoStep(void *c, double point, double size, int past) {
    Unit *u = c;
    int all = u->n + 3;
    double next[SIZE], before = held(u);
    (void)past;
    if (!(size > 0) || fabs(point - u->state.time) > 1e-9 * size) return ERROR;
    if (size != u->step) exponential(u, size);
    for (int i = 0; i < all; i++) {
        next[i] = 0;
        for (int j = 0; j < all; j++) next[i] += u->power[i][j] * u->state.x[j];
    }
    memcpy(u->state.x, next, all * sizeof(double));
    u->state.x[u->n + 1] = u->state.x[u->n + 2] = 0;
    u->state.z = (held(u) - before) / size;
    return u->state.time = point + size, OK;
}
int fmi2CancelStep(void *c) { return (void)c, ERROR; }
int fmi2GetStatus(void *c, int k, int *v) { return (void)c, (void)k, (void)v, DISCARD; }
int fmi2GetIntegerStatus(void *c, int k, int *v) { return (void)c, (void)k, (void)v, DISCARD; }
int fmi2GetBooleanStatus(void *c, int k, int *v) { return (void)c, (void)k, (void)v, DISCARD; }
int fmi2GetStringStatus(void *c, int k, const char **v) { return (void)c, (void)k, (void)v, DISCARD; }
int fmi2GetRealStatus(void *c, int k, double *v) {
    return (void)k, *v = ((Unit *)c)->state.time, OK;
}
int fmi2GetFMUstate(void *c, void **s) {
    if (!*s) *s = malloc(sizeof(State));
    return memcpy(*s, &((Unit *)c)->state, sizeof(State)), OK;
}
int fmi2SetFMUstate(void *c, void *s) { return memcpy(&((Unit *)c)->state, s, sizeof(State)), OK; }
int fmi2FreeFMUstate(void *c, void **s) { return (void)c, free(*s), *s = NULL, OK; }
int fmi2SerializedFMUstateSize(void *c, void *s, size_t *n) {
    return (void)c, (void)s, *n = sizeof(State), OK;
}
int fmi2SerializeFMUstate(void *c, void *s, char bytes[], size_t n) {
    return (void)c, memcpy(bytes, s, n), OK;
}
int fmi2DeSerializeFMUstate(void *c, const char bytes[], size_t n, void **s) {
    if (n != sizeof(State)) return ERROR;
    if (!*s) *s = malloc(sizeof(State));
    return (void)c, memcpy(*s, bytes, n), OK;
}
int fmi2GetDirectionalDerivative(void *c, const unsigned *u, size_t nu, const unsigned *k, size_t nk,
                                 const double *dk, double *du) {
    return (void)c, (void)u, (void)nu, (void)k, (void)nk, (void)dk, (void)du, ERROR;
}

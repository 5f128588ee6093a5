/* Drives a unit through the C header of FMI 3.0: sets an array, steps, saves and restores,
 * differentiates both ways.
 *
 * Arguments: path of the resources, instantiation token, and the value references of an input (the
 * pressure on 6 tiles), of an output that follows it at once, and of the heat brought in. Answers 0 if all
 * is as it should be.
 */
#include <impinge_fmi3.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPECT(condition)                                             \
  do {                                                                \
    if (!(condition)) {                                               \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
      exit(1);                                                        \
    }                                                                 \
  } while (0)

#define TILES 6

typedef struct {
  int count;
  char last[2048];
} Log;

static void listen(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
                   fmi3String message) {
  Log *log = environment;
  EXPECT(category != NULL && status <= fmi3Fatal);
  snprintf(log->last, sizeof log->last, "%s", message);
  log->count++;
}

static double get(fmi3Instance unit, fmi3ValueReference reference) {
  fmi3Float64 value = NAN;
  EXPECT(fmi3GetFloat64(unit, &reference, 1, &value, 1) == fmi3OK);
  return value;
}

static fmi3Status step(fmi3Instance unit, double point, double size) {
  fmi3Boolean event = true, end = true, early = true;
  fmi3Float64 time = NAN;
  fmi3Status status = fmi3DoStep(unit, point, size, false, &event, &end, &early, &time);
  EXPECT(status == fmi3Error || (!event && !end && !early && time == point + size));
  return status;
}

int main(int argc, char **argv) {
  EXPECT(argc == 6);
  const fmi3ValueReference pressure = (fmi3ValueReference)strtoul(argv[3], NULL, 10);
  const fmi3ValueReference stress = (fmi3ValueReference)strtoul(argv[4], NULL, 10);
  const fmi3ValueReference heat = (fmi3ValueReference)strtoul(argv[5], NULL, 10);
  Log log = {0, ""};

  EXPECT(strcmp(fmi3GetVersion(), "3.0") == 0);
  fmi3Instance unit = fmi3InstantiateCoSimulation("from C", argv[2], argv[1], false, false, false,
                                                  false, NULL, 0, &log, listen, NULL);
  EXPECT(unit != NULL);
  EXPECT(fmi3EnterInitializationMode(unit, false, 0.0, 0.0, false, 0.0) == fmi3OK);
  EXPECT(fmi3ExitInitializationMode(unit) == fmi3OK);

  const double size = 1e-8;
  fmi3Float64 load[TILES] = {1e6, 2e6, 3e6, 4e6, 5e6, 6e6}, seen[TILES] = {0};
  EXPECT(fmi3SetFloat64(unit, &pressure, 1, load, TILES) == fmi3OK);
  EXPECT(fmi3GetFloat64(unit, &pressure, 1, seen, TILES) == fmi3OK);
  EXPECT(memcmp(load, seen, sizeof load) == 0);
  EXPECT(step(unit, 0.0, size) == fmi3OK);

  fmi3FMUState state = NULL, copy = NULL;
  size_t bytes_needed = 0;
  EXPECT(fmi3GetFMUState(unit, &state) == fmi3OK && state != NULL);
  EXPECT(fmi3SerializedFMUStateSize(unit, state, &bytes_needed) == fmi3OK && bytes_needed > 0);
  fmi3Byte *bytes = malloc(bytes_needed);
  EXPECT(bytes != NULL && fmi3SerializeFMUState(unit, state, bytes, bytes_needed) == fmi3OK);
  EXPECT(step(unit, size, size) == fmi3OK);
  const double after = get(unit, heat), at_rest = get(unit, stress);
  EXPECT(fmi3DeserializeFMUState(unit, bytes, bytes_needed, &copy) == fmi3OK && copy != state);
  EXPECT(fmi3SetFMUState(unit, copy) == fmi3OK);
  EXPECT(step(unit, size, size) == fmi3OK);
  EXPECT(get(unit, heat) == after && get(unit, stress) == at_rest);
  EXPECT(fmi3FreeFMUState(unit, &copy) == fmi3OK && copy == NULL);
  free(bytes);

  /* Stress is linear in pressure, with what the derivatives say, forwards and backwards. */
  const fmi3Float64 one = 1.0;
  fmi3Float64 seed[TILES], change = 0.0, row[TILES], sum = 0.0, power = 0.0;
  for (int i = 0; i < TILES; i++) {
    seed[i] = 1e5 * (i + 1);
    load[i] += seed[i];
  }
  EXPECT(fmi3GetDirectionalDerivative(unit, &stress, 1, &pressure, 1, seed, TILES, &change, 1) ==
         fmi3OK);
  EXPECT(fmi3GetAdjointDerivative(unit, &stress, 1, &pressure, 1, &one, 1, row, TILES) == fmi3OK);
  for (int i = 0; i < TILES; i++) {
    sum += row[i] * seed[i];
  }
  EXPECT(fabs(sum / change - 1.0) < 1e-12);
  EXPECT(fmi3SetFloat64(unit, &pressure, 1, load, TILES) == fmi3OK);
  EXPECT(fabs((get(unit, stress) - at_rest) / change - 1.0) < 1e-9);
  const fmi3Int32 first = 1;
  EXPECT(fmi3GetOutputDerivatives(unit, &heat, 1, &first, &power, 1) == fmi3OK && power > 0.0);

  EXPECT(log.count == 0);
  EXPECT(step(unit, 1.0, size) == fmi3Error && log.count == 1);
  EXPECT(strstr(log.last, "communication point") != NULL);
  EXPECT(fmi3EnterEventMode(unit) == fmi3Error && log.count == 2);
  EXPECT(fmi3Terminate(unit) == fmi3OK);
  fmi3FreeInstance(unit);
  return 0;
}

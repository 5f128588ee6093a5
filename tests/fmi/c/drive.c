/* Drives a unit through the C header: sets, steps, saves and restores, differentiates.
 *
 * Arguments: URI of the resources, GUID, and the value references of an input (a pressure), of an
 * output that follows it at once, and of the heat brought in. Answers 0 if all is as it should be.
 */
#include <impinge.h>

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPECT(condition)                                                  \
  do {                                                                     \
    if (!(condition)) {                                                    \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition);      \
      exit(1);                                                             \
    }                                                                      \
  } while (0)

typedef struct {
  int count;
  char last[2048];
} Log;

static void listen(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status,
                   fmi2String category, fmi2String format, ...) {
  Log *log = environment;
  va_list arguments;
  EXPECT(strcmp(instance, "from C") == 0 && category != NULL && status <= fmi2Fatal);
  va_start(arguments, format);
  vsnprintf(log->last, sizeof log->last, format, arguments);
  va_end(arguments);
  log->count++;
}

static double get(fmi2Component unit, fmi2ValueReference reference) {
  fmi2Real value = NAN;
  EXPECT(fmi2GetReal(unit, &reference, 1, &value) == fmi2OK);
  return value;
}

int main(int argc, char **argv) {
  EXPECT(argc == 6);
  const fmi2ValueReference pressure = (fmi2ValueReference)strtoul(argv[3], NULL, 10);
  const fmi2ValueReference stress = (fmi2ValueReference)strtoul(argv[4], NULL, 10);
  const fmi2ValueReference heat = (fmi2ValueReference)strtoul(argv[5], NULL, 10);
  Log log = {0, ""};
  fmi2CallbackFunctions callbacks = {listen, NULL, NULL, NULL, &log};

  EXPECT(strcmp(fmi2GetVersion(), "2.0") == 0);
  EXPECT(strcmp(fmi2GetTypesPlatform(), "default") == 0);
  fmi2Component unit =
      fmi2Instantiate("from C", fmi2CoSimulation, argv[2], argv[1], &callbacks, 0, 0);
  EXPECT(unit != NULL);
  EXPECT(fmi2SetupExperiment(unit, 0, 0.0, 0.0, 0, 0.0) == fmi2OK);
  EXPECT(fmi2EnterInitializationMode(unit) == fmi2OK);
  EXPECT(fmi2ExitInitializationMode(unit) == fmi2OK);

  const double step = 1e-8;
  fmi2Real load = 1e6, slope = 1e13;
  const fmi2Integer first = 1;
  EXPECT(fmi2SetReal(unit, &pressure, 1, &load) == fmi2OK);
  EXPECT(fmi2SetRealInputDerivatives(unit, &pressure, 1, &first, &slope) == fmi2OK);
  EXPECT(fmi2DoStep(unit, 0.0, step, 0) == fmi2OK);
  EXPECT(fabs(get(unit, pressure) / (load + slope * step) - 1.0) < 1e-12);

  fmi2FMUstate state = NULL, copy = NULL;
  size_t size = 0;
  EXPECT(fmi2GetFMUstate(unit, &state) == fmi2OK && state != NULL);
  EXPECT(fmi2SerializedFMUstateSize(unit, state, &size) == fmi2OK && size > 0);
  fmi2Byte *bytes = malloc(size);
  EXPECT(bytes != NULL && fmi2SerializeFMUstate(unit, state, bytes, size) == fmi2OK);
  EXPECT(fmi2DoStep(unit, step, step, 1) == fmi2OK);
  const double after = get(unit, heat), at_rest = get(unit, stress);
  EXPECT(fmi2DeSerializeFMUstate(unit, bytes, size, &copy) == fmi2OK && copy != state);
  EXPECT(fmi2SetFMUstate(unit, copy) == fmi2OK);
  EXPECT(fmi2DoStep(unit, step, step, 1) == fmi2OK);
  EXPECT(get(unit, heat) == after && get(unit, stress) == at_rest);
  EXPECT(fmi2FreeFMUstate(unit, &copy) == fmi2OK && copy == NULL);
  free(bytes);

  /* Stress is linear in pressure, with what the derivative says. */
  fmi2Real one = 1.0, change = 0.0, power = 0.0;
  EXPECT(fmi2GetDirectionalDerivative(unit, &stress, 1, &pressure, 1, &one, &change) == fmi2OK);
  load = get(unit, pressure) + 5e5;
  EXPECT(fmi2SetReal(unit, &pressure, 1, &load) == fmi2OK);
  EXPECT(fabs((get(unit, stress) - at_rest) / (5e5 * change) - 1.0) < 1e-9);
  EXPECT(fmi2GetRealOutputDerivatives(unit, &heat, 1, &first, &power) == fmi2OK && power > 0.0);

  fmi2Real time = 0.0;
  EXPECT(log.count == 0);
  EXPECT(fmi2DoStep(unit, 1.0, step, 1) == fmi2Error && log.count == 1);
  EXPECT(strstr(log.last, "communication point") != NULL);
  EXPECT(fmi2GetRealStatus(unit, fmi2LastSuccessfulTime, &time) == fmi2OK && time == 2.0 * step);
  EXPECT(fmi2CancelStep(unit) == fmi2Error);
  EXPECT(fmi2Terminate(unit) == fmi2OK);
  fmi2FreeInstance(unit);
  return 0;
}

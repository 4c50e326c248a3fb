// Loaded before a program (LD_PRELOAD): METIS as it is while the program gets a SIGTERM, which METIS traps
// and takes for an error of its own.
int METIS_NodeND(void) {
  const int metisError = -4;
  return metisError;
}

// A shared library that opens and updates, but lacks all other functions.
extern "C" int pmdOpen() { return 0; }
extern "C" int pmdUpdate() { return 0; }
extern "C" int pmdClose() { return 0; }
extern "C" int pmdGetLastError() { return 0; }

// A shared library that opens and updates, and lacks all the rest.
extern "C" int pmdOpen() { return 0; }
extern "C" int pmdUpdate() { return 0; }
extern "C" int pmdClose() { return 0; }
extern "C" int pmdGetLastError() { return 0; }

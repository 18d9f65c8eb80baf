// For builds with Q3RT_SANITIZE: what the leak report at the program's end leaves out, and why.

extern "C" [[gnu::visibility("default")]] const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    // The validation layer keeps some of its own records of shaders and pipelines (seen with 1.3.239, also where
    // nothing fails). Objects that we forget to destroy it names itself when the device goes, and the test fails by
    // that.
    return "leak:libVkLayer_khronos_validation.so\n";
}

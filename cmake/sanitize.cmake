# Address and undefined behaviour sanitizers for everything; included right after project() by the preset "sanitize".
set(SOFTSHADOW_SANITIZE_FLAGS -fsanitize=address,undefined)
add_compile_options(${SOFTSHADOW_SANITIZE_FLAGS} -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
add_link_options(${SOFTSHADOW_SANITIZE_FLAGS})

# The loader unloads drivers at the end, after which leak reports name no module and no suppression matches: every
# program gets a dlclose that does nothing. By linker flags, because what is linked by target would be exported.
set(keep_modules ${CMAKE_BINARY_DIR}/keep_modules)
file(WRITE ${keep_modules}.c "int dlclose(void *module);

int dlclose(void *module)
{
    (void)module;
    return 0;
}
")
execute_process(COMMAND ${CMAKE_C_COMPILER} -c ${keep_modules}.c -o ${keep_modules}.o COMMAND_ERROR_IS_FATAL ANY)
string(APPEND CMAKE_EXE_LINKER_FLAGS " -rdynamic \"${keep_modules}.o\"")

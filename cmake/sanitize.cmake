# Address and undefined behaviour sanitizers for everything; included right after project() by the preset "sanitize".
set(SOFTSHADOW_SANITIZE_FLAGS -fsanitize=address,undefined)
add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
add_link_options(${SOFTSHADOW_SANITIZE_FLAGS})

# The loader unloads drivers at the end, after which leak reports name no module and no suppression matches.
file(WRITE ${CMAKE_BINARY_DIR}/keep_modules.c "int dlclose(void *module);

int dlclose(void *module)
{
    (void)module;
    return 0;
}
")
add_library(softshadow_keep_modules OBJECT ${CMAKE_BINARY_DIR}/keep_modules.c)
set(executable $<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>)
link_libraries($<${executable}:$<TARGET_OBJECTS:softshadow_keep_modules>>)
add_link_options($<${executable}:-rdynamic>)

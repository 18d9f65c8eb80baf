// Points of a measured front: PRESET(name, ms, SSIM, settings), and the levels that rt_targetMs moves along,
// LEVEL(ms, SSIM, settings), each dearer and better than the one before. Made by q3rt trade --presets.
// oa_dm1, 3 views, 96x72, llvmpipe (LLVM 15.0.6, 256 bits), back end query, renderer 24b7c4d6880face3
// build/q3rt trade --map oa_dm1 --at spawn:0..2 --size 96x72 --warmup 5 --count 5 --reference-frames 256 --axis rt_numRandomDL=1,2,4,8,16,0 --axis rt_denoiser=0,1 --axis rt_taa=0,1 --axis rt_cullLights=1 --out front.jsonl --presets renderer_rt/presets.def.h
PRESET("fast", 9.650, 0.9602, "rt_cullLights 1 rt_denoiser 0 rt_numRandomDL 1 rt_taa 0")
PRESET("balanced", 20.166, 0.9845, "rt_cullLights 1 rt_denoiser 1 rt_numRandomDL 1 rt_taa 1")
PRESET("quality", 31.583, 0.9846, "rt_cullLights 1 rt_denoiser 1 rt_numRandomDL 4 rt_taa 1")
PRESET("reference", 98.111, 0.9847, "rt_cullLights 1 rt_denoiser 1 rt_numRandomDL 8 rt_taa 1")
LEVEL(20.166, 0.9845, "rt_numRandomDL 1")
LEVEL(27.954, 0.9846, "rt_numRandomDL 2")
LEVEL(31.583, 0.9846, "rt_numRandomDL 4")
LEVEL(98.111, 0.9847, "rt_numRandomDL 8")

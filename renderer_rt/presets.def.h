// Points of a measured front: PRESET(name, ms, SSIM, settings), and the levels that rt_targetMs moves along,
// LEVEL(ms, SSIM, settings), each dearer and better than the one before. Made by q3rt trade --presets.
// time on the device; oa_dm1, 2 views, 960x540, NVIDIA H200, back end compute, renderer 5966e28377b49c18
// ./q3rt trade --map oa_dm1 --at spawn:0..1 --size 960x540 --set rt_antialiasing=1 --axis rt_numRandomDL=1,2,4,0 --axis rt_denoiser=0,1 --axis rt_taa=0,1 --axis rt_scale=50,55,60,65,70,75,80,85,90,95,100 --axis rt_cullLights=2 --awake 0.3 --count 20 --seconds-per-point 1 --clock device --warmup 32 --pictures 1 --reference-frames 1024 --reference-error 0.0005 --basepath base --out presets/presets.jsonl --presets presets.def.h
PRESET("fast", 0.432, 0.9820, "rt_antialiasing 1 rt_cullLights 2 rt_denoiser 1 rt_numRandomDL 1 rt_scale 50 rt_taa 1")
PRESET("balanced", 0.877, 0.9953, "rt_antialiasing 1 rt_cullLights 2 rt_denoiser 1 rt_numRandomDL 1 rt_scale 90 rt_taa 1")
PRESET("quality", 1.267, 0.9966, "rt_antialiasing 1 rt_cullLights 2 rt_denoiser 1 rt_numRandomDL 2 rt_scale 100 rt_taa 1")
PRESET("reference", 4.198, 0.9973, "rt_antialiasing 1 rt_cullLights 2 rt_denoiser 1 rt_numRandomDL 0 rt_scale 100 rt_taa 1")
LEVEL(0.432, 0.9820, "rt_numRandomDL 1 rt_scale 50")
LEVEL(0.472, 0.9859, "rt_numRandomDL 1 rt_scale 55")
LEVEL(0.518, 0.9886, "rt_numRandomDL 1 rt_scale 60")
LEVEL(0.567, 0.9904, "rt_numRandomDL 1 rt_scale 65")
LEVEL(0.625, 0.9920, "rt_numRandomDL 1 rt_scale 70")
LEVEL(0.691, 0.9930, "rt_numRandomDL 1 rt_scale 75")
LEVEL(0.747, 0.9941, "rt_numRandomDL 1 rt_scale 80")
LEVEL(0.810, 0.9949, "rt_numRandomDL 1 rt_scale 85")
LEVEL(0.877, 0.9953, "rt_numRandomDL 1 rt_scale 90")
LEVEL(0.951, 0.9958, "rt_numRandomDL 1 rt_scale 95")
LEVEL(1.029, 0.9960, "rt_numRandomDL 1 rt_scale 100")
LEVEL(1.167, 0.9961, "rt_numRandomDL 2 rt_scale 95")
LEVEL(1.267, 0.9966, "rt_numRandomDL 2 rt_scale 100")
